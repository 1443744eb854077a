/** The table as all its pages share it: what is done here goes out, what others do comes in. */

import { batch, computed, effect, type Signal, signal } from "@preact/signals";
import { Refused, Unanswered } from "../../../core/connection";
import {
  type Content,
  cellNamed,
  digestOf,
  type Entry,
  type ProposalEntry,
  postureEntry,
  type RobotText,
  shapeOf,
} from "../../../core/design/entries";
import { Outbox } from "../../../core/design/outbox";
import type { Proposed } from "../../../core/design/roles";
import { SharedTable } from "../../../core/design/shared_table";
import { pageTable, withoutProposed } from "../../../core/design/shown";
import { columnsOf, type Table } from "../../../core/design/table";
import { sequences } from "../../../core/files";
import type { OpenedTable, TableNews } from "../../../core/wire";
import type { OpenFile } from "../files/open_file";
import type { Gateway } from "../gateway";
import type { ReadRobot, RobotInUse } from "../robot/robot";
import type { Place, Sheet } from "../table/sheet";

/** Two updates of this page have at least so much time between them. */
const PACE_MS = 40;
const READ_AGAIN_MS = 2000;

export class Sharing {
  /** Whether everything that was done here is on the gateway's disk. */
  readonly isKept = signal(true);
  /** What partners propose. */
  readonly proposals = signal<readonly ProposalEntry[]>([]);
  private shared = this.fresh();
  /** What was typed into tables that this page has left, and the gateway does not have. */
  private readonly left = new Map<string, ReadonlyMap<string, Entry | undefined>>();
  private readonly outbox = new Outbox();
  /** Name and document of the table; null: not greeted yet. */
  private name: string | null = null;
  private epoch = "";
  /** Number of the newest update that was taken in. */
  private seen = 0;
  /** Whether what is on the page goes into the document. */
  private readonly isOn = signal(false);
  /** Whether nobody could take what this page did last. */
  private isRefused = false;
  /** A table of so many rows, or more, stays on this page. */
  private mostRows = Number.POSITIVE_INFINITY;
  /** Whether the first things are being opened into an empty table. */
  private begins = false;
  /** The robot that others have chosen, until it is read. */
  private readonly coming = signal<{ robot: RobotText | null } | null>(null);
  private timer = 0;

  /** What is on the page; null: nothing yet. */
  private readonly local = computed<Content | null>(() => {
    const table = this.sheet.table.value;
    if (!table) return null;
    const { kind, legs, rows } = table;
    const used = this.robot.used.value;
    const own = used?.text == null ? null : { name: used.name, text: used.text };
    const robot = this.coming.value ? this.coming.value.robot : own;
    const { name, version, saved } = this.file.value;
    const lacking = this.robot.isSaved.value ? null : this.robot.versionOf(used?.name ?? "");
    return {
      kind,
      legs: legs.length,
      rows,
      keys: sequences.value,
      robot,
      file: { name, version, digest: saved, robotVersion: lacking },
    };
  });

  /**
   * @param file The file that the table comes from.
   * @param me The nickname; "": whoever designs alone.
   * @param clashed Somebody typed into the same cells at the same time.
   */
  constructor(
    private readonly gateway: Gateway,
    private readonly sheet: Sheet,
    private readonly robot: RobotInUse,
    private readonly file: Signal<OpenFile>,
    private readonly me: () => string,
    private readonly clashed: (places: readonly Place[], by: number) => void,
  ) {
    effect(() => {
      const content = this.local.value;
      if (this.isOn.value && content && this.mayHave(content)) this.shared.write(content);
    });
  }

  /** The table in the document; null: it is empty. */
  content(): Content | null {
    return this.shared.content();
  }

  /** The gateway has let the page in, for the first time or again. */
  greet(opened: OpenedTable): void {
    const isOther = this.name !== null && this.name !== opened.table;
    const isAlone = !opened.state.length && !isOther;
    const isAhead = isAlone && !this.shared.isEmpty && !this.isRefused;
    this.outbox.returned();
    const isLate = this.outbox.begins && opened.state.length > 0;
    if (this.name === null || isLate || (this.epoch !== opened.epoch && !isAhead)) {
      this.change(opened, isOther);
      this.send();
      return;
    }
    this.epoch = opened.epoch; // the gateway has lost its document, and gets this one
    const rows = this.shared.rowNames();
    if (opened.state.length) this.shared.take(opened.state);
    this.show(rows);
    const missing = this.shared.missingIn(opened.state);
    if (missing) this.outbox.add(missing, [], this.begins);
    this.send();
    this.seen = opened.seq;
  }

  /** Take in a message of the gateway. */
  take(news: TableNews): void {
    if (news.state) {
      this.change({ ...news, state: news.state, others: 0 }, news.table !== this.name);
      this.send();
    } else if (news.epoch === this.epoch) {
      if (news.update) {
        const rows = this.shared.rowNames();
        this.shared.take(news.update);
        this.show(rows);
      }
      if (news.clash) this.clashed(this.shared.placesOf(news.clash.cells), news.clash.by);
      this.seen = news.seq;
    }
  }

  /** Propose cells of rows that others own. */
  propose(table: Table, proposed: readonly Proposed[], by: string): void {
    if (table.kind !== "postures") return; // nobody owns its rows
    const shape = shapeOf({ kind: table.kind, legs: table.legs.length });
    const values = proposed.map(
      ({ row, col, cell }) => [`${postureEntry(shape, row.key)}/${col}`, String(cell)] as const,
    );
    this.shared.propose(values, by);
  }

  /** Remove proposals, by the names of their entries. */
  dismiss(names: readonly string[]): void {
    this.shared.remove(names);
  }

  /** The first things are open: from now on the document has what is on the page. */
  begin(): void {
    if (this.isOn.peek()) return;
    this.begins = this.shared.isEmpty;
    this.isOn.value = true;
    this.begins = false;
  }

  /** Go on with another document, and add what the gateway does not have of the old one. */
  private change(opened: OpenedTable, isOther: boolean): void {
    const unsent = new Map<string, Entry | undefined>();
    for (const name of this.outbox.names) unsent.set(name, this.shared.get(name));
    if (isOther && unsent.size) this.left.set(this.name ?? "", unsent);
    const own = isOther ? this.left.get(opened.table) : unsent;
    this.left.delete(opened.table);
    this.outbox.clear();
    const rows = this.shared.rowNames();
    this.shared = this.fresh();
    this.name = opened.table;
    this.epoch = opened.epoch;
    this.seen = opened.seq;
    if (opened.state.length) this.shared.take(opened.state);
    if (!this.isOn.peek()) return;
    if (own) this.shared.put(own);
    const content = this.content();
    if (content) this.show(rows, isOther);
    else {
      const local = this.local.peek();
      if (local && this.isRefused) this.mostRows = local.rows.length;
      else if (local && this.mayHave(local)) this.shared.write(local);
    }
    this.isRefused = false;
  }

  /** Whether the document may have this content. */
  private mayHave({ rows }: Content): boolean {
    return rows.length < this.mostRows;
  }

  /** Whether the gateway has all of the page's table. */
  private get hasAll(): boolean {
    const local = this.local.peek();
    return this.outbox.isEmpty && (!local || this.mayHave(local));
  }

  /** A document; its updates go out. */
  private fresh(): SharedTable {
    const shared: SharedTable = new SharedTable((update, names) => {
      if (shared !== this.shared) return;
      this.outbox.add(update, names, this.begins);
      this.isKept.value = false;
      this.lookForProposals();
      this.send();
    });
    return shared;
  }

  private send(): void {
    clearTimeout(this.timer);
    const parcel = this.name === null ? null : this.outbox.next(this.seen);
    if (!parcel) {
      this.isKept.value = this.hasAll;
      return;
    }
    this.isKept.value = false;
    const { epoch } = this;
    const { update, names, begins, seen } = parcel;
    const cells = names.filter(cellNamed);
    const fields = { table: this.name, epoch, seen, update, cells, begins };
    const sentMs = performance.now();
    this.gateway.ask<{ seq: number }>("table", fields).then(
      () => {
        if (epoch !== this.epoch) return;
        this.outbox.confirmed();
        const rest = Math.max(0, sentMs + PACE_MS - performance.now());
        this.isKept.value = this.hasAll;
        this.timer = window.setTimeout(() => this.send(), rest);
      },
      (error: unknown) => {
        if (epoch !== this.epoch) return;
        this.outbox.returned();
        if (error instanceof Unanswered || !this.gateway.state.peek().open) return; // greets again
        if ((error as Refused).why.code === "gateway.too-much") {
          this.timer = window.setTimeout(() => this.send(), READ_AGAIN_MS);
          return;
        }
        // Nobody can take it: this page goes on with what all others have. If they have nothing,
        // the table stays here.
        if ((error as Refused).why.code !== "tables.older") {
          this.outbox.clear();
          this.isRefused = true;
          this.gateway.refuse(error);
        }
        this.epoch = "";
        void this.gateway.greetAgain();
      },
    );
  }

  private lookForProposals(): void {
    const found = this.shared.proposals();
    if (found.length || this.proposals.peek().length) this.proposals.value = found;
  }

  /**
   * Show what the document has.
   *
   * @param rows The names of the rows that the page shows.
   */
  private show(rows: readonly string[], isOther = false): void {
    const content = this.content();
    const before = this.sheet.table.peek();
    if (!content || !before || !this.isOn.peek()) {
      this.lookForProposals();
      return;
    }
    const at = new Map(this.shared.rowNames().map((name, row) => [name, row]));
    const moved = (row: number) => at.get(rows[row] ?? "") ?? null;
    batch(() => {
      const table = this.tableOf(content);
      if (isOther) this.sheet.open(table);
      else if (digestOf(before) !== digestOf(table)) {
        // What was proposed here and taken in was typed here.
        const me = this.me();
        const own = me ? this.proposals.peek().filter(({ by }) => by === me) : [];
        const others = withoutProposed(before, table, own);
        const isMine = others !== table;
        if (isMine) this.sheet.merge(others, null, moved);
        this.sheet.merge(table, isMine ? "hand" : null, isMine ? undefined : moved);
      }
      if (content.keys.join() !== sequences.peek().join()) sequences.value = content.keys;
      const { name, version, digest } = content.file;
      const file = this.file.peek();
      if (file.name !== name || file.version !== version || file.saved !== digest) {
        this.file.value = { name, version, saved: digest };
      }
      this.lookForProposals();
      this.useRobot(content);
    });
  }

  private tableOf(content: Content): Table {
    const robot = this.robot.robot.peek();
    return pageTable(content, robot && columnsOf(robot), this.sheet.table.peek());
  }

  /** Use the robot that others have chosen. */
  private useRobot({ robot: chosen }: Content): void {
    const used = this.robot.used.peek();
    const isSame = (used?.text ?? null) === (chosen?.text ?? null);
    if (isSame && (!chosen || used?.name === chosen.name)) {
      this.coming.value = null;
      return;
    }
    const coming = { robot: chosen };
    this.coming.value = coming;
    void this.readRobot(coming);
  }

  private async readRobot(coming: { robot: RobotText | null }): Promise<void> {
    let read: ReadRobot;
    try {
      read = await this.robot.read(coming.robot?.name ?? "", coming.robot?.text ?? null);
    } catch (error) {
      if (!(error instanceof Refused)) throw error;
      const again = () => this.coming.peek() === coming && void this.readRobot(coming);
      setTimeout(again, READ_AGAIN_MS);
      return;
    }
    if (this.coming.peek() !== coming) return;
    const content = this.content();
    batch(() => {
      this.sheet.useRobot({ ...read, isEdited: content?.file.robotVersion !== null });
      this.coming.value = null;
      if (content) this.sheet.merge(this.tableOf(content));
    });
  }
}
