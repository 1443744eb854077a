/** Other gaits that the coach has found: a map of them, and rounds of six variants. */

import { computed, signal } from "@preact/signals";
import { change, type Table } from "../../../core/design/table";
import type { CoachReply, MapReply, OtherGait, VariantsReply } from "../../../core/wire";
import { t } from "../../../i18n";
import { type SentGait, sentGait } from "../files/gait";
import type { RobotInUse } from "../robot/robot";
import type { Sheet } from "../table/sheet";
import type { Trials } from "../trials/trials";
import type { Search } from "./search";

type Changes = CoachReply["changes"];

/** The student's table from which other gaits were searched. */
interface Base {
  gait: SentGait;
  key: number;
  version: number;
  rows: readonly number[];
}

/** Six variants, and which of them the next six are bred from. */
export interface Round {
  variants: readonly OtherGait[];
  /** Indices of one or two. */
  kept: readonly number[];
}

export const MOST_KEPT = 2;
const FORWARD = 2;
const MAP_S = 30;
/** A studio takes no more tables that were shown before. */
const MOST_BEFORE = 60;

/** A table with the coach's changes. */
export function changed(table: Table, rows: readonly number[], changes: Changes): Table {
  return changes.reduce((made, { cell, to_deg }) => {
    const row = rows[cell.posture] ?? 0;
    const area = { top: row, bottom: row, left: cell.joint, right: cell.joint };
    return change(made, area, () => to_deg);
  }, table);
}

export class Others {
  /** What is in sight; null: what the coach itself has found. */
  readonly looks = signal<"map" | "variants" | null>(null);
  readonly map = signal<MapReply | null>(null);
  /** The chosen cell of the map: speed and arousal. */
  readonly cell = signal<readonly [number, number]>([0, 0]);
  readonly rounds = signal<readonly Round[]>([]);
  /** The round in sight. */
  readonly at = signal(0);
  readonly round = computed<Round | null>(() => this.rounds.value[this.at.value] ?? null);
  private readonly base = signal<Base | null>(null);
  /** Whether what was found is about the table as it is now. */
  readonly isCurrent = computed(() => this.base.value?.version === this.sheet.version.value);

  constructor(
    private readonly search: Search,
    private readonly sheet: Sheet,
    private readonly robot: RobotInUse,
    private readonly trials: Trials,
  ) {}

  get isSearching(): boolean {
    return this.search.job.value !== null;
  }

  /** Search for a map of gaits. */
  async askMap(): Promise<void> {
    const base = this.begin();
    if (!base) return;
    this.map.value = null;
    this.looks.value = "map";
    const { gait, key } = base;
    const fields = { ...gait, key, seconds: MAP_S, seed: 0 };
    const reply = await this.search.ask<MapReply>("map", fields);
    if (!reply) return;
    const first = reply.cells[0];
    this.cell.value = reply.own ?? (first ? [first.speed, first.arousal] : [0, 0]);
    this.map.value = reply;
  }

  /** Search for the first six variants. */
  async askVariants(): Promise<void> {
    const base = this.begin();
    if (!base) return;
    this.rounds.value = [];
    this.looks.value = "variants";
    await this.breed(base, []);
  }

  /** Keep a variant to breed from, or keep it no longer. */
  keep(index: number): void {
    const at = this.at.peek();
    this.rounds.value = this.rounds.peek().map((round, number) => {
      if (number !== at) return round;
      const { kept } = round;
      const others = kept.filter((one) => one !== index);
      return {
        ...round,
        kept: others.length < kept.length ? others : [...kept, index].slice(-MOST_KEPT),
      };
    });
  }

  /** Go to the next round: to the one that was seen before, if there is one, else to a new one. */
  async next(): Promise<void> {
    const base = this.base.peek();
    if (base) await this.breed(base, this.rounds.peek().slice(0, this.at.peek() + 1));
  }

  back(): void {
    this.at.value = Math.max(0, this.at.peek() - 1);
  }

  /** Let the robot walk with a gait that was found; it is no trial of the student's. */
  watch(gait: OtherGait, name: string): void {
    const base = this.base.peek();
    const table = this.sheet.table.peek();
    if (!base || !table || !this.isCurrent.peek()) return;
    void this.trials.watch(changed(table, base.rows, gait.changes), base.rows, base.key, name);
  }

  /** Put a gait that was found into the table, in one step, and let it walk. */
  take(gait: OtherGait, name: string): void {
    const base = this.base.peek();
    const now = this.sheet.table.peek();
    if (!base || !now || !this.isCurrent.peek()) return;
    const table = changed(now, base.rows, gait.changes);
    // Put, not edited: halves that mirror each other would make another gait of it.
    this.sheet.put(t("design.step.other", { name }), table, "coach", { size: "table" });
    void this.trials.tryIt();
  }

  private begin(): Base | null {
    const { sheet } = this;
    sheet.key.value = FORWARD; // both are of gaits that go forward
    const gait = sentGait(sheet, this.robot);
    const rows = sheet.sequence.peek();
    if (!gait || !rows) {
      void this.trials.tryIt(); // says what is missing
      return null;
    }
    const base = { gait, rows, key: FORWARD, version: sheet.version.peek() };
    this.base.value = base;
    return base;
  }

  private async breed({ gait, key }: Base, before: readonly Round[]): Promise<void> {
    const last = before.at(-1);
    const reply = await this.search.ask<VariantsReply>("variants", {
      ...gait,
      key,
      keep: last?.kept.map((index) => last.variants[index]!.table) ?? [],
      before: before
        .flatMap((round) => round.variants.map(({ table }) => table))
        .slice(-MOST_BEFORE),
      round: before.length,
      seed: 0,
    });
    if (!reply) return;
    this.rounds.value = [...before, { variants: reply.variants, kept: [] }];
    this.at.value = before.length;
  }
}
