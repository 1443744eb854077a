/** What the page knows: table, robot, files, trials, and what is looked at. */

import { batch, computed, signal } from "@preact/signals";
import { runKey, socketUrl } from "../../core/address";
import { Connection, Refused } from "../../core/connection";
import { History } from "../../core/design/history";
import { type Guess, type Verdict, verdict } from "../../core/design/predict";
import { sequenceOf } from "../../core/design/rows";
import { type Shown, source } from "../../core/design/sources";
import {
  type Area,
  areaOf,
  badCells,
  type Cell,
  columnsOf,
  fromWire,
  legAndLevel,
  type Table,
  toWire,
} from "../../core/design/table";
import { follow, halvesOf } from "../../core/design/tools";
import { readTrial, type Trial } from "../../core/design/trial";
import { sequences } from "../../core/files";
import type { Phrase } from "../../core/phrase";
import type {
  FileTable,
  FolderFile,
  Judged,
  Message,
  Mistake,
  Phases,
  Progress,
  RobotReply,
  SentFile,
  TrialReply,
} from "../../core/wire";
import { said, t } from "../../i18n";
import { toast } from "../../ui/toasts";
import { Clock } from "./clock";

/** A place in the table. */
export interface Place {
  row: number;
  col: number;
}

/** A trial that was made on this page, with the version of the table that it belongs to. */
export interface Tried {
  number: number;
  version: number;
  table: Table;
  /** A key of level B, or such as "A1" of level A. */
  key: number | string;
  /** The rows that the key ran through. */
  rows: readonly number[];
  robot: RobotReply;
  trial: Trial;
  /** What was foretold, and what came of it. */
  verdicts: readonly { guess: Guess; verdict: Verdict }[];
}

/** The file that the table was read from. */
export interface OpenFile {
  /** "" while the table has no file. */
  name: string;
  /** The file's version when it was read or saved last. */
  version: string;
  /** The table's version that the file has. */
  saved: number;
}

/** A file that has another content than the page thought. */
export interface Conflict {
  name: string;
  version: string;
  table: FileTable | null;
  mistakes: readonly Mistake[];
  /** Saving over a file that was opened or over another one, or the file changed while it is open. */
  when: "saving" | "existing" | "open";
}

interface ReadReply {
  table: FileTable | null;
  robot: string | null;
  version: string;
  notes: Phrase[];
  mistakes?: Mistake[];
}

/** A parsed file or pasted sheet. */
type Parsed = Pick<ReadReply, "table" | "robot" | "notes">;

/** Errors that stay in sight until the next try. */
export interface Trouble {
  said: Phrase;
  mistakes: readonly Mistake[];
}

/** What is tried of level A in phases 2 and 3: a posture, or one posture after another. */
export type Pose = "A1" | "A1, A2";

/** How an edit was made; null: none that counts as one's own work. */
type By = "hand" | "tool" | "paste" | "coach" | null;

const POSES: Record<Pose, { keys: string; seconds: number; measured: number }> = {
  A1: { keys: "A1", seconds: 3, measured: 1 },
  "A1, A2": { keys: "A1:1, A2", seconds: 1.5, measured: 2 },
};
const LEARN_MS = 250;
const FORWARD = 2;
const MOST_TRIALS = 40;
const STANDING_KEYS = 9;
const NO_FILE: OpenFile = { name: "", version: "", saved: 0 };

export class Studio {
  readonly connection: Connection;
  /** Whether a studio answers; null: not known yet. */
  readonly present = signal<boolean | null>(null);
  readonly folder = signal<{ folder: string; files: readonly FolderFile[] }>({
    folder: "",
    files: [],
  });
  readonly robot = signal<RobotReply | null>(null);
  /** Name of the robot's file; "": the workshop's hexapod. */
  readonly robotName = signal("");
  readonly history = signal<History | null>(null);
  readonly file = signal<OpenFile>(NO_FILE);
  readonly conflict = signal<Conflict | null>(null);
  /** Whether somebody chose to begin with a new table or the sample: no file takes its place. */
  private isAskedFor = false;
  readonly trouble = signal<Trouble | null>(null);

  readonly active = signal<Place>({ row: 0, col: 0 });
  readonly anchor = signal<Place>({ row: 0, col: 0 });
  /** What is being typed into the active cell: the picture shows it already; null: nothing. */
  readonly draft = signal<Cell | null>(null);
  readonly area = computed<Area>(() => areaOf(this.anchor.value, this.active.value));
  /** Joints that are pointed at; empty: those of the active cell are lit. */
  readonly pointed = signal<readonly number[]>([]);
  /** Joints that glow and whose columns are marked. */
  readonly lit = computed<readonly number[]>(() =>
    this.pointed.value.length ? this.pointed.value : [this.active.value.col],
  );

  /** Cells where what was pasted can't stand, with the reason; until the next edit or move. */
  readonly unpasted = signal<readonly (Place & { why: string })[]>([]);

  /** The key of level B that a trial presses. */
  readonly key = signal(FORWARD);
  /** What is pressed of level A instead of the key; null: the key is. */
  readonly pose = signal<Pose | null>(null);
  /** How far the student is in the six phases; null: not known yet. */
  readonly phases = signal<Phases | null>(null);
  /** Where the student says that a foot goes with the next edit. */
  readonly footGuess = signal<string | null>(null);
  /** What came of the last such guess. */
  readonly judged = signal<Judged | null>(null);
  /** Whether the second half of the key's sequence follows the first as its mirror. */
  readonly mirrors = signal(false);
  readonly trying = signal(false);
  /** What the next trial is foretold to do. */
  readonly guesses = signal<readonly Guess[]>([]);
  readonly progress = signal<(Progress & { job: string }) | null>(null);
  readonly trials = signal<readonly Tried[]>([]);
  readonly shown = signal<Tried | null>(null);
  /** The trial that the shown one is compared with. */
  readonly other = signal<Tried | null>(null);
  /** Whether the picture shows the trial; else it shows the posture of the active row. */
  readonly watching = signal(false);
  readonly clock = new Clock();

  readonly table = computed<Table | null>(() => this.history.value?.table.value ?? null);
  readonly version = computed(() => this.history.value?.version.value ?? 0);
  readonly isSaved = computed(() => this.file.value.saved === this.version.value);
  /** The rows that the chosen key runs through; null if it has none. */
  readonly sequence = computed<readonly number[] | null>(() => {
    const table = this.table.value;
    return table && sequenceOf(table, this.key.value, sequences.value);
  });
  readonly bad = computed(() => (this.table.value ? badCells(this.table.value) : []));
  /** What the picture shows. */
  readonly picture = source(
    computed(() => (this.watching.value && this.shown.value?.robot) || this.robot.value),
    computed<Shown | null>(() => {
      const { shown, watching, table } = this;
      if (watching.value && shown.value) {
        return { trial: shown.value.trial, tick: this.clock.tick.value };
      }
      const { row, col } = this.active.value;
      const cells = table.value?.rows[row]?.cells;
      const draft = this.draft.value;
      return cells ? { cells: draft === null ? cells : cells.with(col, draft) } : null;
    }),
  );
  private robotText: string | null = null;
  /** Why no studio answers. */
  readonly why = signal<Phrase | null>(null);
  /** The robot of the command line. */
  private first: SentFile | null = null;
  /** The edits that the gateway does not know yet; null: none. */
  private untold: { by: By; size: string | null; timer: number } | null = null;
  private greeted = false;
  private opened = false;
  private again = false;

  constructor() {
    const url = socketUrl("/design/ws");
    this.connection = new Connection(
      url,
      () => this.greet(),
      (message) => this.take(message),
    );
  }

  // The table

  /** Edit the table: one step that can be undone. */
  edit(
    name: string,
    change: (table: Table) => Table,
    gesture: string | null = null,
    by: By = "hand",
    size: string | null = null,
  ): void {
    const history = this.history.peek();
    if (!history) return;
    if (this.untold?.by !== by) this.tellEdit();
    const version = this.version.peek();
    const halves = this.mirrors.peek() ? halvesOf(this.sequence.peek() ?? []) : [];
    const whole = (before: Table) => {
      const after = change(before);
      const fits = after.rows.length === before.rows.length;
      return halves.length && fits ? follow(before, after, halves) : after;
    };
    batch(() => {
      this.unpasted.value = [];
      history.apply(name, whole, gesture);
      this.stayInside();
      this.watching.value = false;
    });
    this.clock.pause();
    if (this.version.peek() !== version) this.learn(by, size);
  }

  undo(): void {
    this.tellEdit();
    this.history.peek()?.undo();
    this.learn(null);
    this.stayInside();
    this.watching.value = false;
  }

  redo(): void {
    this.tellEdit();
    this.history.peek()?.redo();
    this.learn(null);
    this.stayInside();
    this.watching.value = false;
  }

  /** Go to a cell, and let the picture show its posture. */
  select(place: Place, from: Place = place): void {
    batch(() => {
      this.unpasted.value = [];
      this.active.value = this.inside(place);
      this.anchor.value = this.inside(from);
      this.watching.value = false;
    });
    this.clock.pause();
  }

  /** Go to a cell, and go on looking at the trial. */
  selectBeside(row: number, col: number): void {
    batch(() => {
      this.active.value = this.anchor.value = this.inside({ row, col });
    });
  }

  /** Light joints because something of theirs is pointed at; none: those of the active cell. */
  point(joints: readonly number[]): void {
    const now = this.pointed.peek();
    const isSame = now.length === joints.length && now.every((one, at) => one === joints[at]);
    if (!isSame) this.pointed.value = joints;
  }

  private inside({ row, col }: Place): Place {
    const rows = this.table.peek()?.rows.length ?? 1;
    const cols = 3 * (this.table.peek()?.legs.length ?? 1);
    return {
      row: Math.min(rows - 1, Math.max(0, row)),
      col: Math.min(cols - 1, Math.max(0, col)),
    };
  }

  private stayInside(): void {
    this.active.value = this.inside(this.active.peek());
    this.anchor.value = this.inside(this.anchor.peek());
  }

  // Files

  /** Open a file of the folder. */
  async open(name: string): Promise<void> {
    const slot = this.folder.peek().files.find((file) => file.name === name)?.slot;
    try {
      const read = await this.connection.ask<ReadReply>("read", { name });
      if (read.robot !== null || slot === "robot") await this.useRobot(name, read.robot ?? "");
      else if (read.table) this.show(read.table, name, read.version);
      this.tell(read.notes);
    } catch (error) {
      this.refuse(error);
    }
  }

  /** Begin with the sample gait of the robot, where it has one. */
  async openSample(): Promise<void> {
    this.isAskedFor = true;
    const { table } = await this.connection.ask<Parsed>("sample");
    const robot = this.robot.peek();
    if (table && table.legs === robot?.legs.length) this.show(table, "", "");
  }

  /** Begin with a table in which all postures are that of the robot at its start. */
  openNew(): void {
    this.isAskedFor = true;
    const robot = this.robot.peek();
    if (robot) this.begin(standing(robot), NO_FILE);
  }

  /** Take a dropped file, or the text of a pasted sheet. */
  async parse(name: string, data: Uint8Array): Promise<void> {
    try {
      const parsed = await this.connection.ask<Parsed>("parse", { name, data });
      if (parsed.robot !== null && parsed.robot !== undefined) {
        await this.useRobot(name, parsed.robot);
      } else if (parsed.table) this.replace(parsed.table, name);
      this.tell(parsed.notes);
    } catch (error) {
      this.refuse(error);
    }
  }

  /** Save the table under a name. */
  async save(name: string, force = false): Promise<boolean> {
    const table = this.table.peek();
    const wire = table && toWire(table);
    if (!table || !wire) {
      toast(t("design.badCells", { count: this.bad.peek().length }), "no");
      return false;
    }
    const version = this.version.peek();
    const own = this.file.peek();
    // Over a file that was not opened here nothing is saved unasked.
    const from = own.name === name ? own.version : "";
    try {
      const reply = await this.connection.ask<{
        version?: string;
        conflict?: { table: FileTable | null; version: string; mistakes?: Mistake[] };
      }>("save", { name, table: wire, version: from, force });
      if (reply.conflict) {
        const { table: theirs, version: now, mistakes = [] } = reply.conflict;
        const when = own.name === name ? "saving" : "existing";
        this.conflict.value = { name, version: now, table: theirs, mistakes, when };
        return false;
      }
      this.file.value = { name, version: reply.version ?? "", saved: version };
      this.conflict.value = null;
      toast(t("design.saved", { name }), "yes");
      return true;
    } catch (error) {
      this.refuse(error);
      return false;
    }
  }

  /** The table as a file's bytes, for a download. */
  async bytes(name: string): Promise<Uint8Array | null> {
    const wire = this.table.peek() && toWire(this.table.peek()!);
    if (!wire) return null;
    try {
      return (await this.connection.ask<{ data: Uint8Array }>("write", { name, table: wire })).data;
    } catch (error) {
      this.refuse(error);
      return null;
    }
  }

  /** Take what the file has now; what was on the page can be had back by undo. */
  takeTheirs(): void {
    const conflict = this.conflict.peek();
    const robot = this.robot.peek();
    if (!conflict?.table || !robot) return;
    const table = fromWire(conflict.table, columnsOf(robot));
    this.edit(t("design.step.theirs"), () => table, null, null);
    this.file.value = {
      name: conflict.name,
      version: conflict.version,
      saved: this.version.peek(),
    };
    this.conflict.value = null;
  }

  /** Keep what is on the page; the next save writes over the file. */
  keepMine(): void {
    const conflict = this.conflict.peek();
    if (!conflict) return;
    this.file.value = { ...this.file.peek(), name: conflict.name, version: conflict.version };
    this.conflict.value = null;
  }

  /** Walk with the workshop's hexapod, or with the robot of a file. */
  async useRobot(name: string, text: string | null): Promise<void> {
    const robot = await this.ask(text === null ? null : { name, text });
    batch(() => {
      this.adopt(name, text, robot);
      const fits = this.table.peek()?.legs.length === robot.legs.length;
      if (!fits) this.begin(standing(robot), NO_FILE);
      else {
        const isSaved = this.isSaved.peek();
        this.history.peek()!.refit(columnsOf(robot));
        if (isSaved) this.file.value = { ...this.file.peek(), saved: this.version.peek() };
      }
    });
  }

  private adopt(name: string, text: string | null, robot: RobotReply): void {
    this.robotText = text;
    this.robotName.value = text === null ? "" : name;
    this.robot.value = robot;
  }

  private async ask(file: { name: string; text: string } | null): Promise<RobotReply> {
    const robot = file && { name: file.name, data: new TextEncoder().encode(file.text) };
    return this.connection.ask<RobotReply>("robot", { robot });
  }

  private begin(table: Table, file: OpenFile): void {
    if (this.table.peek()) this.tellEdit();
    batch(() => {
      const isOther = this.table.peek()?.legs.length !== table.legs.length;
      // Versions go on, so that trials stay with their tables.
      if (this.history.peek()) this.history.peek()!.open(table);
      else this.history.value = new History(table);
      this.file.value = { ...file, saved: this.version.peek() };
      if (isOther) {
        this.trials.value = [];
        this.shown.value = this.other.value = null;
      }
      this.watching.value = false;
      const forward = sequenceOf(table, FORWARD, sequences.peek());
      this.key.value = forward ? FORWARD : 0;
      const first = this.sequence.peek()?.[0] ?? 0;
      this.select({ row: first, col: 0 });
    });
    this.learn(null);
  }

  private show(wire: FileTable, name: string, version: string): void {
    const robot = this.robot.peek();
    if (!robot) return;
    if (wire.legs !== robot.legs.length) {
      toast(t("design.otherLegs", { legs: wire.legs, robot: robot.name }), "no");
    }
    this.begin(fromWire(wire, columnsOf(robot)), { name, version, saved: 0 });
  }

  /** Put a table in place of this one, in one step. */
  private replace(wire: FileTable, name: string): void {
    const robot = this.robot.peek();
    if (!robot) return;
    const table = fromWire(wire, columnsOf(robot));
    if (table.kind !== this.table.peek()?.kind || wire.legs !== robot.legs.length) {
      this.begin(table, NO_FILE);
      return;
    }
    this.edit(t("design.step.take", { name }), () => table, null, "paste");
  }

  private versionOf(name: string): string {
    return this.folder.peek().files.find((file) => file.name === name)?.version ?? "";
  }

  // Trials

  /** Let the robot walk with the table as it is now. */
  async tryIt(): Promise<Tried | null> {
    const [table, robot] = [this.table.peek(), this.robot.peek()];
    const pose = this.pose.peek() && POSES[this.pose.peek()!];
    const rows = pose ? rowsOfPose(table, pose.measured) : this.sequence.peek();
    if (!table || !robot) return null;
    if (this.trying.peek()) {
      this.again = true;
      return null;
    }
    const wire = toWire(table);
    if (!wire) {
      const [first] = this.bad.peek();
      this.select(first!);
      toast(t("design.badCells", { count: this.bad.peek().length }), "no");
      return null;
    }
    if (!rows) {
      toast(t("design.noSequence", { key: this.pose.peek() ?? this.key.peek() }), "no");
      return null;
    }
    this.trying.value = true;
    this.trouble.value = null;
    const [version, key] = [this.version.peek(), this.pressed()];
    try {
      this.tellEdit();
      const reply = await this.connection.ask<TrialReply>("trial", {
        table: wire,
        robot: this.robotFile(),
        sequences: this.digits(table),
        keys: pose ? pose.keys : String(key),
        seconds: pose ? pose.seconds : null,
        guesses: this.guesses.peek().map(({ about, is }) => ({ about, said: is })),
      });
      const last = this.trials.peek().at(-1);
      const tried: Tried = {
        number: (last?.number ?? 0) + 1,
        version,
        table,
        key,
        rows,
        robot,
        trial: readTrial(reply, robot.legs.length),
        verdicts: this.judge(key, reply.figures),
      };
      batch(() => {
        this.guesses.value = [];
        this.trials.value = [...this.trials.peek(), tried].slice(-MOST_TRIALS);
        this.look(tried);
      });
      return tried;
    } catch (error) {
      this.refuse(error);
      return null;
    } finally {
      this.trying.value = false;
      if (this.again) {
        this.again = false;
        void this.tryIt();
      }
    }
  }

  /** The last trial of a key: what the next one is compared with. */
  lastOf(key: number | string): Tried | null {
    return this.trials.peek().findLast((tried) => tried.key === key) ?? null;
  }

  /** What the next trial presses. */
  pressed(): number | string {
    return this.pose.value ?? this.key.value;
  }

  private judge(key: number | string, after: Record<string, unknown>): Tried["verdicts"] {
    const before = this.lastOf(key)?.trial.reply.figures ?? null;
    return this.guesses.peek().flatMap((guess) => {
      const found = verdict(guess, before, after);
      return found ? [{ guess, verdict: found }] : [];
    });
  }

  /** Show a trial from its beginning. */
  look(tried: Tried): void {
    batch(() => {
      this.shown.value = tried;
      this.watching.value = tried.trial.ticks > 0;
      if (this.other.peek() === tried) this.other.value = null;
      this.clock.end.value = Math.max(0, tried.trial.ticks - 1);
      this.clock.tick.value = Math.min(tried.trial.reply.starts[0] ?? 0, this.clock.end.peek());
    });
    if (tried.trial.ticks) this.clock.play();
  }

  /** Go to a tick of the shown trial. */
  seek(tick: number): void {
    this.watching.value = this.shown.peek() !== null;
    this.clock.seek(tick);
  }

  /** Put the table of a trial back, in one step. */
  restore(tried: Tried): void {
    this.edit(t("design.step.restore", { number: tried.number }), () => tried.table, null, null);
  }

  /** The files that a request to the studio is about. */
  request(): object | null {
    const table = this.table.peek();
    const wire = table && toWire(table);
    if (!wire) return null;
    return { table: wire, robot: this.robotFile(), sequences: this.digits(table) };
  }

  /** Say what a request was refused for. */
  refuse(error: unknown): void {
    if (!(error instanceof Refused)) throw error;
    if (error.mistakes.length) {
      // A robot and a gait may both have mistakes: neither list hides the other.
      const before = this.trouble.peek()?.mistakes ?? [];
      this.trouble.value = { said: error.why, mistakes: [...before, ...error.mistakes] };
    } else toast(said(error.why), "no");
  }

  private robotFile(): { name: string; data: Uint8Array } | null {
    if (this.robotText === null) return null;
    return { name: this.robotName.peek(), data: new TextEncoder().encode(this.robotText) };
  }

  private digits(table: Table): number[][] | null {
    if (table.kind === "locomotion") return null;
    const keys = new Set(table.rows.map(({ key }) => key));
    // Each key needs postures, also one that is not tried, and whose own are not all there.
    const filler = [table.rows[0]!.key];
    return sequences.peek().map((digits) => {
      const found = [...digits].map(Number);
      return found.length && found.every((digit) => keys.has(digit)) ? found : filler;
    });
  }

  private tell(notes: readonly Phrase[] = []): void {
    for (const note of notes) toast(said(note));
  }

  // The six phases

  /** Go to a phase, forward or back. */
  async goTo(number: number): Promise<void> {
    await this.evidence("phase", { number });
  }

  /** Send something that counts as evidence; null: it was refused. */
  async evidence<T>(
    what: "phase" | "name" | "vote" | "check",
    fields: Record<string, unknown>,
  ): Promise<T | null> {
    this.tellEdit();
    try {
      return await this.connection.ask<T>(what, fields);
    } catch (error) {
      this.refuse(error);
      return null;
    }
  }

  /** Tell the gateway of an edit, after a moment in which more of the same kind may come. */
  private learn(by: By, size: string | null = null): void {
    if (this.untold) clearTimeout(this.untold.timer);
    // What could not be told yet, because a cell has no angle, is told with this.
    const first = this.untold ?? { by, size };
    const timer = window.setTimeout(() => this.tellEdit(), LEARN_MS);
    this.untold = { ...first, timer };
  }

  /** Tell the gateway of the edits that it does not know yet. */
  private tellEdit(): void {
    const untold = this.untold;
    const files = untold && this.greeted ? this.request() : null;
    if (!untold || !files) return;
    clearTimeout(untold.timer);
    this.untold = null;
    const guess = untold.by === "hand" ? this.footGuess.peek() : null;
    if (guess) this.footGuess.value = null;
    const { by, size } = untold;
    const ask = this.connection.ask<{ guess: Judged | null }>("edit", {
      ...files,
      by,
      size,
      guess,
    });
    ask.then(
      (reply) => {
        if (guess) this.judged.value = reply.guess;
      },
      // The next edit tells it, or the next connection.
      () => {},
    );
  }

  // The connection

  private async greet(): Promise<void> {
    const hello = { key: runKey() ?? "" };
    const { robot } = await this.connection.ask<{ robot: SentFile | null }>("hello", hello);
    this.first = robot;
    this.greeted = true;
    if (this.table.peek()) this.learn(null);
    void this.openFirst();
  }

  private take(message: Message): void {
    if (message.kind === "studio") {
      const was = this.present.peek();
      this.present.value = message.body.present;
      this.why.value = message.body.why;
      if (!was && message.body.present) void this.openFirst();
    } else if (message.kind === "phases") {
      this.phases.value = message.body;
    } else if (message.kind === "progress") {
      this.progress.value = message.body;
    } else if (message.kind === "folder") {
      const { folder, files, changed } = message.body;
      this.folder.value = { folder, files };
      void this.openFirst();
      for (const name of changed) void this.changed(name);
    }
  }

  /** The first thing to see: the robot, and the folder's first gait, else the sample. */
  private async openFirst(): Promise<void> {
    if (this.opened || !this.greeted || !this.present.peek()) return;
    this.opened = true;
    try {
      const { name, text, robot } = await this.firstRobot();
      const { files } = this.folder.peek();
      const gait =
        files.find(({ slot }) => slot === "postures") ??
        files.find(({ slot }) => slot === "locomotion");
      const read = await this.firstTable(gait?.name ?? "");
      batch(() => {
        this.adopt(name, text, robot);
        if (read?.table?.legs !== robot.legs.length) this.begin(standing(robot), NO_FILE);
        else this.show(read.table, read.version ? gait!.name : "", read.version);
      });
      this.tell(read?.notes);
    } catch (error) {
      this.opened = false;
      this.refuse(error);
    }
  }

  /** The robot of the command line, that of the folder, or the workshop's. */
  private async firstRobot(): Promise<{ name: string; text: string | null; robot: RobotReply }> {
    try {
      let [name, text] = ["", null as string | null];
      const own = this.folder.peek().files.find(({ slot }) => slot === "robot");
      if (this.first) {
        name = this.first.name;
        text = new TextDecoder().decode(this.first.data);
      } else if (own) {
        name = own.name;
        text = (await this.connection.ask<ReadReply>("read", { name })).robot;
      }
      return { name, text, robot: await this.ask(text === null ? null : { name, text }) };
    } catch (error) {
      this.refuse(error);
      return { name: "", text: null, robot: await this.ask(null) };
    }
  }

  /** The table of a file, or of the sample; null where there is none without mistakes. */
  private async firstTable(name: string): Promise<(Parsed & { version: string }) | null> {
    try {
      if (name) return await this.connection.ask<ReadReply>("read", { name });
      return { ...(await this.connection.ask<Parsed>("sample")), version: "" };
    } catch (error) {
      this.refuse(error);
      return null;
    }
  }

  /** A file of the folder was saved by another program. */
  private async changed(name: string): Promise<void> {
    if (name === this.robotName.peek()) {
      await this.open(name);
      return;
    }
    const own = this.file.peek();
    const now = this.versionOf(name);
    // The first gait of the folder, or one whose mistakes were corrected.
    const isUntouched = this.isSaved.peek() && !this.trials.peek().length;
    const isFree = own.name === "" && isUntouched && !this.isAskedFor;
    if (isFree && now && /^loco/i.test(name)) {
      this.trouble.value = null;
      await this.open(name);
      return;
    }
    if (name !== own.name || now === own.version || !now) return;
    try {
      const read = await this.connection.ask<ReadReply>("read", { name });
      if (!read.table || read.version === this.file.peek().version) return;
      const conflict = { name, version: read.version, table: read.table, mistakes: [] };
      this.conflict.value = { ...conflict, when: "open" };
      // Nothing of one's own would be lost.
      if (this.isSaved.peek()) {
        this.takeTheirs();
        toast(t("design.reread", { name }));
      }
    } catch (error) {
      this.refuse(error);
    }
  }
}

/** The row that a trial of level A measures; null if there is none. */
function rowsOfPose(table: Table | null, key: number): number[] | null {
  const row = table?.kind === "postures" ? table.rows.findIndex((one) => one.key === key) : -1;
  return row < 0 ? null : [row];
}

/** A table to begin with: all postures are that in which the robot stands. */
export function standing(robot: RobotReply): Table {
  const rows = Array.from({ length: STANDING_KEYS }, (_, key) => ({
    key,
    posture: 0,
    angles_deg: robot.start_deg,
  }));
  return fromWire({ kind: "postures", legs: robot.legs.length, rows }, columnsOf(robot));
}

/** "R,F 1st" */
export function jointName(legs: readonly string[], joint: number): string {
  const { leg, level } = legAndLevel(joint, legs.length);
  return `${legs[leg] ?? leg} ${["Root", "1st", "2nd"][level]}`;
}
