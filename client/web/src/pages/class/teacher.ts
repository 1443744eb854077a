/** What the teacher's page knows of the class, and what it asks of the gateway. */

import { batch, computed, signal } from "@preact/signals";
import { runKey, socketUrl } from "../../core/address";
import { masked, numbered, OPEN_RULES, placed, toggled, withCard } from "../../core/class";
import { Connection, Refused } from "../../core/connection";
import { download } from "../../core/files";
import type { Phrase } from "../../core/phrase";
import { remembered } from "../../core/settings";
import { tab } from "../../core/storage";
import {
  type Card,
  type ClassState,
  type FileTable,
  type Message,
  type Mistake,
  PARSE_MAX_BYTES,
  type Request,
  type ShowReply,
  type StudentRules,
  type TournamentState,
} from "../../core/wire";
import { sentence, t } from "../../i18n";
import { toast } from "../../ui/toasts";

/** What fills the screen: how to join, a student's robot, the standings, or what is printed. */
export type Screen =
  | { shows: "room" | "standings" | "certificates" }
  | { shows: "robot"; name: string };

/** A table that is about to be handed out. */
export interface Handout {
  title: string;
  table: FileTable;
}

interface Parsed {
  table: FileTable | null;
}

const NOW_MS = 5000;
const PING_MS = 2000;
const TYPES = { evidence: "text/csv", tables: "application/zip" };
const NO_TOURNAMENT: TournamentState = {
  state: "none",
  arena: "",
  done: 0,
  of: 0,
  matches: [],
  standings: [],
  left_out: [],
  trouble: null,
};

export class Teacher {
  readonly connection: Connection;
  readonly state = signal<ClassState | null>(null);
  readonly cards = signal<readonly Card[]>([]);
  readonly tournament = signal<TournamentState>(NO_TOURNAMENT);
  /** As they are shown: a click is answered at once, the gateway's word holds. */
  readonly rules = signal<StudentRules>(OPEN_RULES);
  /** The student whose details are open; "": none. */
  readonly opened = signal("");
  readonly screen = signal<Screen | null>(null);
  readonly handout = signal<Handout | null>(null);
  /** A file that could not be read. */
  readonly trouble = signal<{ why: Phrase | string; mistakes: readonly Mistake[] } | null>(null);
  /** Whether cards keep their places, because somebody is about to click one. */
  readonly holds = signal(false);
  /** Whether names are hidden. */
  readonly projector = remembered("class.projector", false);
  /** Unix time. */
  readonly nowS = signal(Date.now() / 1000);
  /** The names by which a projector's numbers go; they end with the tab. */
  private readonly robots = remembered<readonly string[]>("class.robots", [], tab);
  /** The order so far, which cards keep while they are held. */
  private shown: readonly string[] = [];
  /** Number of changes of the rules that have no answer yet. */
  private changing = 0;

  /** The cards in the order in which they stand on the page. */
  readonly order = computed<readonly Card[]>(() => {
    // On the big screen, the next student and the one before stay the same.
    const holds = this.holds.value || this.screen.value?.shows === "robot";
    const order = placed(this.shown, this.cards.value, holds);
    this.shown = order.map(({ name }) => name);
    return order;
  });
  readonly groups = computed(() => this.state.value?.groups ?? []);
  /** The group to which a table is handed out; "": to all. */
  readonly recipient = signal("");
  /** The same, but "" also if the group has ended. */
  readonly group = computed(
    () => this.groups.value.find(({ name }) => name === this.recipient.value)?.name ?? "",
  );
  readonly here = computed(() => this.cards.value.filter(({ online }) => online).length);
  readonly hands = computed(
    () => this.cards.value.filter((card) => card.online && card.need === "hand").length,
  );

  constructor() {
    this.connection = new Connection(
      socketUrl("class/ws"),
      () => this.connection.ask("hello", { key: runKey() ?? "" }),
      (message) => this.take(message),
    );
    setInterval(() => {
      this.nowS.value = Date.now() / 1000;
    }, NOW_MS);
    // A class may be quiet for long: only an answer shows that the gateway is there.
    setInterval(() => this.connection.ask("ping").catch(() => undefined), PING_MS);
  }

  /** What a student is called on this page. */
  name(student: string): string {
    return this.projector.value ? this.label(this.robots.value.indexOf(student)) : student;
  }

  /** What a player of the tournament is called on this page: a student, or a group. */
  player(name: string): string {
    return this.card(name) ? this.name(name) : this.hide(name);
  }

  /** A text in which no name stands that must not be seen. */
  hide(text: string): string {
    if (!this.projector.value) return text;
    return masked(text, this.robots.value, (index) => this.label(index));
  }

  /** The card of a student; undefined: deleted. */
  card(student: string): Card | undefined {
    return this.cards.value.find(({ name }) => name === student);
  }

  /** Ask the gateway; what it refuses is said, and comes back as null. */
  async act<T = unknown>(what: Request, fields: object = {}): Promise<T | null> {
    try {
      return await this.connection.ask<T>(what, fields);
    } catch (error) {
      if (!(error instanceof Refused)) throw error;
      const { why, mistakes } = error;
      if (mistakes.length) this.trouble.value = { why, mistakes };
      else toast(() => this.reason(why), "no");
      return null;
    }
  }

  /** Why something was refused, in words. */
  reason(why: Phrase | string): string {
    return this.hide(sentence(why));
  }

  async change(rules: StudentRules): Promise<void> {
    this.rules.value = rules;
    this.changing += 1;
    await this.act("rules", { rules });
    this.changing -= 1;
    if (!this.changing) this.rules.value = this.state.peek()?.rules ?? OPEN_RULES;
  }

  toggle(phase: number): void {
    void this.change(toggled(this.rules.peek(), phase));
  }

  /** Read a file that shall be handed out. */
  async takeIn(file: File): Promise<void> {
    const { name } = file;
    if (file.size > PARSE_MAX_BYTES) {
      toast(t("files.tooLarge", { name }), "no");
      return;
    }
    try {
      const data = new Uint8Array(await file.arrayBuffer());
      const parsed = await this.act<Parsed>("parse", { name, data });
      if (!parsed) return;
      if (!parsed.table) toast(t("class.handOut.robot", { name }), "no");
      else this.handout.value = { title: name.replace(/\.[^.]*$/, ""), table: parsed.table };
    } catch {
      toast(t("files.unreadable", { name }), "no"); // such as a folder
    }
  }

  /** Hand out a table, that of a student, or else the sample, to whom the teacher has chosen. */
  async handOut(title: string, what: { table?: FileTable; student?: string } = {}): Promise<void> {
    const group = this.group.peek();
    if ((await this.act("hand_out", { title, ...what, group })) === null) return;
    const to = this.hide(group);
    toast(
      group ? t("class.handOut.doneTo", { title, to }) : t("class.handOut.done", { title }),
      "yes",
    );
  }

  async save(what: "evidence" | "tables"): Promise<void> {
    const file = await this.act<{ name: string; data: Uint8Array }>("export", { what });
    if (file) download(file.name, [file.data.slice()], TYPES[what]);
  }

  /** A trial of a student's newest table. Rejects with `Refused`. */
  show(student: string): Promise<ShowReply> {
    return this.connection.ask<ShowReply>("show", { student });
  }

  private label(index: number): string {
    return t("class.robot", { number: index < 0 ? "?" : index + 1 });
  }

  private take(message: Message): void {
    if (message.kind === "class") {
      const { body } = message;
      batch(() => {
        this.state.value = body;
        // What was chosen since must not go back, or the next choice would lose it.
        if (!this.changing) this.rules.value = body.rules;
        if (body.cards) this.deal(body.cards);
      });
    } else if (message.kind === "card") {
      this.deal(withCard(this.cards.peek(), message.body));
    } else if (message.kind === "gone") {
      this.deal(this.cards.peek().filter(({ name }) => name !== message.body.name));
    } else if (message.kind === "tournament") {
      const before = this.tournament.peek().state;
      this.tournament.value = message.body;
      const isOver = before === "running" && message.body.state === "done";
      // The room looks at this page: it sees the result.
      if (isOver && this.projector.peek() && !this.screen.peek() && !this.opened.peek()) {
        this.screen.value = { shows: "standings" };
      }
    }
  }

  private deal(cards: readonly Card[]): void {
    const names = cards.map(({ name }) => name);
    batch(() => {
      this.cards.value = cards;
      this.robots.value = numbered(this.robots.peek(), names);
      if (!names.includes(this.opened.peek())) this.opened.value = "";
    });
  }
}
