/** Keeps the table that is edited, and all its steps for undo and redo. */

import { batch, computed, type ReadonlySignal, signal } from "@preact/signals";
import { changesBetween, type Moved } from "./rebase";
import { type Columns, type Row, refit, type Table } from "./table";

interface Step {
  /** Name of the step, for the buttons; "" for the first table. */
  readonly name: string;
  readonly table: Table;
  readonly version: number;
  /** Name of a gesture, such as one drag of a slider; all its edits together are one step. */
  readonly gesture: string | null;
  /** The robot that the table is for, as the page knows it. */
  readonly robot: unknown;
}

export class History {
  readonly table: ReadonlySignal<Table>;
  readonly canUndo: ReadonlySignal<boolean>;
  readonly canRedo: ReadonlySignal<boolean>;
  /** Names of the steps that undo and redo would take; "": there is no such step. */
  readonly undoName: ReadonlySignal<string>;
  readonly redoName: ReadonlySignal<string>;
  /** Number of the table's content: equal contents have equal numbers. Trials belong to it. */
  readonly version: ReadonlySignal<number>;
  /** The robot of the step; null: none was named. */
  readonly robot: ReadonlySignal<unknown>;
  private readonly steps = signal<readonly Step[]>([]);
  private readonly at = signal(0);
  private readonly versions = new Map<string, number>();
  private readonly rows = new Map<string, number>();
  private readonly rowNumbers = new WeakMap<Row, number>();

  constructor(table: Table, robot: unknown = null) {
    this.open(table, robot);
    const now = computed(() => this.steps.value[this.at.value]!);
    this.table = computed(() => now.value.table);
    this.version = computed(() => now.value.version);
    this.robot = computed(() => now.value.robot);
    this.canUndo = computed(() => this.at.value > 0);
    this.canRedo = computed(() => this.at.value < this.steps.value.length - 1);
    this.undoName = computed(() => (this.canUndo.value ? now.value.name : ""));
    this.redoName = computed(() => this.steps.value[this.at.value + 1]?.name ?? "");
  }

  /** Begin again with another table, such as that of another file; version numbers go on. */
  open(table: Table, robot: unknown = null): void {
    batch(() => {
      const version = this.numberOf(table);
      this.steps.value = [{ name: "", table, version, gesture: null, robot }];
      this.at.value = 0;
    });
  }

  /** Replace a robot in all steps. */
  useRobot(before: unknown, now: unknown): void {
    this.steps.value = this.steps
      .peek()
      .map((step) => (step.robot === before ? { ...step, robot: now } : step));
  }

  /** Give all steps the columns of another robot with as many legs; this is no step to undo. */
  refit(columns: Columns): void {
    this.steps.value = this.steps.peek().map((step) => {
      const table = refit(step.table, columns) ?? step.table;
      return { ...step, table, version: this.numberOf(table) };
    });
  }

  /**
   * Take in what others did: every step has it, so undo takes back only what was done here. Steps
   * that have nothing of their own any more are left out.
   *
   * @param moved Where rows are now.
   * @returns What it makes of the tables that were steps before.
   */
  rebase(to: Table, moved?: Moved): (table: Table) => Table {
    const change = changesBetween(this.table.peek(), to, moved);
    const before = this.steps.peek();
    const at = this.at.peek();
    const kept: Step[] = [];
    let now = 0;
    before.forEach((step, index) => {
      const table = change(step.table);
      const version = this.numberOf(table);
      const last = kept.at(-1);
      if (last?.version === version && last.robot === step.robot) {
        // The newest name stays: it says what undo leads back from.
        kept[kept.length - 1] = { ...last, table };
      } else kept.push({ ...step, table, version });
      if (index === at) now = kept.length - 1;
    });
    batch(() => {
      this.steps.value = kept;
      this.at.value = now;
    });
    return change;
  }

  /**
   * Edit the table, or take it over to another robot: one step, unless nothing changes.
   *
   * @param name Name of the step, for the buttons.
   * @param edit Returns the changed table.
   * @param gesture Edits in a row with the same gesture, such as a drag of a slider, are one step.
   * @param other The robot from this step on; left out: it stays.
   */
  apply(
    name: string,
    edit: (table: Table) => Table,
    gesture: string | null = null,
    other?: unknown,
  ): void {
    const before = this.steps.peek()[this.at.peek()]!;
    const robot = other === undefined ? before.robot : other;
    const table = edit(before.table);
    const version = this.numberOf(table);
    if (version === before.version && robot === before.robot) return;
    const goesOn = gesture !== null && before.gesture === gesture;
    const kept = this.steps.peek().slice(0, this.at.peek() + (goesOn ? 0 : 1));
    // A drag that ends where it began leaves no step.
    const last = kept.at(-1);
    const isBack = goesOn && last?.version === version && last.robot === robot;
    const steps = isBack ? kept : [...kept, { name, table, version, gesture, robot }];
    batch(() => {
      this.steps.value = steps;
      this.at.value = steps.length - 1;
    });
  }

  /** Whether a table of this content was here before. */
  has(table: Table): boolean {
    return this.versions.has(this.contentOf(table));
  }

  undo(): void {
    if (this.canUndo.peek()) this.at.value = this.at.peek() - 1;
  }

  redo(): void {
    if (this.canRedo.peek()) this.at.value = this.at.peek() + 1;
  }

  private numberOf(table: Table): number {
    const content = this.contentOf(table);
    const number = this.versions.get(content) ?? this.versions.size + 1;
    this.versions.set(content, number);
    return number;
  }

  private contentOf(table: Table): string {
    return `${table.kind} ${table.rows.map((row) => this.rowNumber(row)).join(" ")}`;
  }

  /** Number of a row's content; with it, the content of a long table is named by a short text. */
  private rowNumber(row: Row): number {
    let number = this.rowNumbers.get(row);
    if (number === undefined) {
      const content = JSON.stringify([row.key, row.posture, row.cells]);
      number = this.rows.get(content) ?? this.rows.size;
      this.rows.set(content, number);
      this.rowNumbers.set(row, number);
    }
    return number;
  }
}
