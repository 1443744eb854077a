/** The table that is edited: its steps, the place in it, and the key whose rows are worked on. */

import { batch, computed, type Signal, signal } from "@preact/signals";
import { digestOf } from "../../../core/design/entries";
import { History } from "../../../core/design/history";
import type { Moved } from "../../../core/design/rebase";
import { sequenceOf } from "../../../core/design/rows";
import {
  type Area,
  areaOf,
  badCells,
  type Cell,
  columnsOf,
  type Table,
} from "../../../core/design/table";
import { follow, halvesOf } from "../../../core/design/tools";
import { sequences } from "../../../core/files";
import type { ReadRobot } from "../robot/robot";

/** A place in the table. */
export interface Place {
  row: number;
  col: number;
}

/** How an edit was made; null: none that counts as one's own work. */
export type By = "hand" | "tool" | "paste" | "coach" | "lesson" | null;

/** Who is told what happens to the table. */
export interface Followers {
  /** An edit without what the student may not change. */
  guard(before: Table, after: Table): Table;
  /** A step comes. What was done before can be told now; edits made `by` the same may wait. */
  before(by?: By): void;
  /** The table has changed. */
  changed(by: By, size: string | null): void;
  /** Others have changed the table. */
  merged(before: Table, now: Table): void;
  /** The table got another kind or another number of legs. */
  turned(before: Table, now: Table): void;
  /** Another table with another number of legs was opened. */
  legsChanged(): void;
  /** Somebody works on the table, and looks at a posture. */
  worked(): void;
}

/** A step that changed the keys' sequences too: the table and the sequences on both sides of it. */
interface KeyStep {
  readonly from: Table;
  readonly to: Table;
  readonly fromKeys: readonly string[];
  readonly toKeys: readonly string[];
}

const FORWARD = 2;

/** What a step may change besides the table. */
interface Others {
  /** The digits of each key of level B. */
  keys?: readonly string[] | null;
  /** The robot from this step on. */
  robot?: ReadRobot;
  /** How much the coach was allowed to change. */
  size?: string | null;
}

export class Sheet {
  readonly history = signal<History | null>(null);
  readonly table = computed<Table | null>(() => this.history.value?.table.value ?? null);
  readonly version = computed(() => this.history.value?.version.value ?? 0);
  /** Name of the table's content. */
  readonly digest = computed(() => (this.table.value ? digestOf(this.table.value) : ""));
  readonly bad = computed(() => (this.table.value ? badCells(this.table.value) : []));

  readonly active = signal<Place>({ row: 0, col: 0 });
  readonly anchor = signal<Place>({ row: 0, col: 0 });
  readonly area = computed<Area>(() => areaOf(this.anchor.value, this.active.value));
  /** What is being typed into the active cell: the picture shows it already; null: nothing. */
  readonly draft = signal<Cell | null>(null);
  /** The cells of the active row, with what is being typed; null: there is no table. */
  readonly posture = computed<readonly Cell[] | null>(() => {
    const { row, col } = this.active.value;
    const cells = this.table.value?.rows[row]?.cells ?? null;
    const draft = this.draft.value;
    return cells && draft !== null ? cells.with(col, draft) : cells;
  });
  /** Cells where what was pasted can't stand, with the reason; until the next edit or move. */
  readonly unpasted = signal<readonly (Place & { why: string })[]>([]);
  /** Joints that are pointed at; empty: those of the active cell are lit. */
  private readonly pointed = signal<readonly number[]>([]);
  /** Joints that glow and whose columns are marked. */
  readonly lit = computed<readonly number[]>(() =>
    this.pointed.value.length ? this.pointed.value : [this.active.value.col],
  );

  /** The chosen key of level B. */
  readonly key = signal(FORWARD);
  /** The rows that the chosen key runs through; null if it has none. */
  readonly sequence = computed<readonly number[] | null>(() => {
    const table = this.table.value;
    return table && sequenceOf(table, this.key.value, sequences.value);
  });
  /** Whether the second half of the key's sequence follows the first as its mirror. */
  readonly mirrors = signal(false);

  /** Steps that changed the keys' sequences too. */
  private keySteps: KeyStep[] = [];

  /** @param robot The robot on the page; each step brings back its own. */
  constructor(
    private readonly followers: Followers,
    private readonly robot: Signal<ReadRobot | null>,
  ) {}

  /** Begin with another table. Versions go on, so that trials stay with their tables. */
  open(table: Table): void {
    const before = this.table.peek();
    if (before) this.followers.before();
    batch(() => {
      const robot = this.robot.peek();
      if (before) this.history.peek()!.open(table, robot);
      else this.history.value = new History(table, robot);
      if (before?.legs.length !== table.legs.length) this.followers.legsChanged();
      this.key.value = sequenceOf(table, FORWARD, sequences.peek()) ? FORWARD : 0;
      this.select({ row: this.sequence.peek()?.[0] ?? 0, col: 0 });
    });
    this.followers.changed(null, null);
  }

  /**
   * Take the table over to another robot of as many legs: one step.
   *
   * @param gesture Changes in a row with the same gesture are one step.
   */
  refit(name: string, robot: ReadRobot, gesture: string | null = null): void {
    this.followers.before();
    batch(() => {
      this.history.peek()?.apply(name, (table) => table, gesture, robot);
      this.takeRobot();
      this.followers.worked();
    });
    this.followers.changed("tool", null);
  }

  /**
   * Edit the table: one step that can be undone.
   *
   * @param gesture Edits in a row with the same gesture are one step.
   * @param size How much the coach was allowed to change.
   */
  edit(
    name: string,
    change: (table: Table) => Table,
    gesture: string | null = null,
    by: By = "hand",
    size: string | null = null,
  ): void {
    const history = this.history.peek();
    if (!history) return;
    this.followers.before(by);
    const version = this.version.peek();
    const halves = this.mirrors.peek() ? halvesOf(this.sequence.peek() ?? []) : [];
    const whole = (before: Table) => {
      const after = change(before);
      const fits = after.rows.length === before.rows.length;
      const whole = halves.length && fits ? follow(before, after, halves) : after;
      return this.followers.guard(before, whole);
    };
    batch(() => {
      this.unpasted.value = [];
      history.apply(name, whole, gesture);
      this.stayInside();
      this.followers.worked();
    });
    if (this.version.peek() !== version) this.followers.changed(by, size);
  }

  /**
   * Put another table in place of this one: one step, whatever its kind and legs.
   *
   * @param others What else the step changes; what is left out stays as it is.
   * @returns Whether anything has changed.
   */
  put(
    name: string,
    table: Table,
    by: By,
    { keys = null, robot, size = null }: Others = {},
  ): boolean {
    const history = this.history.peek();
    const from = this.table.peek();
    if (!history || !from) return false;
    this.followers.before(by);
    const fromKeys = sequences.peek();
    batch(() => {
      this.unpasted.value = [];
      history.apply(name, () => table, null, robot);
      const to = this.table.peek()!;
      if (keys) sequences.value = keys;
      if (keys && to !== from) this.keySteps.push({ from, to, fromKeys, toKeys: keys });
      this.turn(from);
      this.takeRobot();
    });
    const isChanged = this.table.peek() !== from || keys !== null;
    if (isChanged) this.followers.changed(by, size);
    return isChanged;
  }

  /**
   * Take in what others did to the table: it is no step of this page.
   *
   * @param by Where others took in what was typed here.
   * @param moved Where rows are now: what is being typed stays in its row.
   */
  merge(table: Table, by: By = null, moved: Moved = (row) => row): void {
    const history = this.history.peek();
    const from = this.table.peek();
    if (!history || !from) return;
    if (by) this.followers.before(by);
    batch(() => {
      const change = history.rebase(table, moved);
      const follow = ({ row, col }: Place) => ({ row: moved(row) ?? row, col });
      this.active.value = follow(this.active.peek());
      this.anchor.value = follow(this.anchor.peek());
      this.keySteps = this.keySteps.map((step) => ({
        ...step,
        from: change(step.from),
        to: change(step.to),
      }));
      if (from.legs.length !== table.legs.length) this.followers.legsChanged();
      if (!this.sequence.peek()) {
        this.key.value = sequenceOf(table, FORWARD, sequences.peek()) ? FORWARD : 0;
      }
      this.stayInside();
    });
    if (by) this.followers.changed(by, null);
    else this.followers.merged(from, table);
  }

  /** Take in that others have chosen another robot: it is no step of this page. */
  useRobot(robot: ReadRobot): void {
    const before = this.robot.peek();
    batch(() => {
      this.robot.value = robot;
      const history = this.history.peek();
      history?.useRobot(before, robot);
      history?.refit(columnsOf(robot.reply));
      if (before?.reply.legs.length !== robot.reply.legs.length) this.followers.legsChanged();
    });
  }

  /** Give the keys of level B other sequences. */
  setKeys(keys: readonly string[]): void {
    this.followers.before();
    sequences.value = keys;
    this.followers.changed("tool", null);
  }

  undo(): void {
    this.go((history) => history.undo());
  }

  redo(): void {
    this.go((history) => history.redo());
  }

  /** Go to a cell, and let the picture show its posture. */
  select(place: Place, from: Place = place): void {
    batch(() => {
      this.unpasted.value = [];
      this.active.value = this.inside(place);
      this.anchor.value = this.inside(from);
      this.followers.worked();
    });
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

  private go(step: (history: History) => void): void {
    const history = this.history.peek();
    if (!history) return;
    this.followers.before();
    const from = this.table.peek()!;
    batch(() => {
      step(history);
      const to = this.table.peek();
      for (const one of this.keySteps) {
        if (one.to === from && one.from === to) sequences.value = one.fromKeys;
        else if (one.from === from && one.to === to) sequences.value = one.toKeys;
      }
      this.turn(from);
      this.takeRobot();
    });
    this.followers.changed(null, null);
  }

  /** Take in that a step may have led to another robot. */
  private takeRobot(): void {
    const history = this.history.peek();
    const robot = history?.robot.peek() as ReadRobot | null;
    if (!robot || robot === this.robot.peek()) return;
    this.robot.value = robot;
    history?.refit(columnsOf(robot.reply));
  }

  /** Take in that a step may have led to a table of another shape. */
  private turn(from: Table): void {
    const to = this.table.peek()!;
    const isOther = to.legs.length !== from.legs.length;
    if (isOther || to.kind !== from.kind) this.followers.turned(from, to);
    if (isOther) this.followers.legsChanged();
    if (!this.sequence.peek()) {
      this.key.value = sequenceOf(to, FORWARD, sequences.peek()) ? FORWARD : 0;
    }
    this.stayInside();
    this.followers.worked();
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
}
