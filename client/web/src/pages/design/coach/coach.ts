/** The coach: what was asked, what was found, and what of it is to be seen. */

import { computed, signal } from "@preact/signals";
import type { CoachReply } from "../../../core/wire";
import { t } from "../../../i18n";
import { sentGait } from "../files/gait";
import type { RobotInUse } from "../robot/robot";
import type { Sheet } from "../table/sheet";
import type { Trials } from "../trials/trials";
import { changed, type Others } from "./others";
import type { Search } from "./search";

export const GOALS = ["forward", "left", "right"] as const;
export type Goal = (typeof GOALS)[number];
export const SIZES = ["cell", "three", "table"] as const;
export type Size = (typeof SIZES)[number];

/** What turning a number up or down does to the score. */
type Effect = "good" | "bad" | "none";

/** How much a number matters, for its cell. */
export interface Marked {
  /** From 0 to 1 of the number that matters most. */
  share: number;
  up: Effect;
  down: Effect;
  text: string;
}

/** What the coach found. */
export interface Found {
  reply: CoachReply;
  /** The version of the table, and the rows of the key, that it is about. */
  version: number;
  rows: readonly number[];
  /** How much the coach was allowed to change; null: it was asked which numbers matter. */
  size: Size | null;
  goal: Goal;
}

const SECONDS = 30;
/** A smaller change of the score is none. */
const SMALL = 2.5;
const KEY_OF: Record<Goal, number> = { forward: 2, left: 1, right: 3 };

export class Coach {
  readonly goal = signal<Goal>("forward");
  readonly found = signal<Found | null>(null);
  /** Whether the student has guessed, so that what was found may be seen. */
  readonly revealed = signal(false);
  /** The marks of the cells by row and joint; null while none are to be seen. */
  readonly marks = computed(() => this.marksSeen());

  constructor(
    readonly search: Search,
    readonly others: Others,
    private readonly sheet: Sheet,
    private readonly robot: RobotInUse,
    private readonly trials: Trials,
  ) {}

  /** Walk for another goal: with its key. */
  aim(goal: Goal): void {
    this.goal.value = goal;
    this.sheet.key.value = KEY_OF[goal];
  }

  /** Ask for a better gait; null: which numbers matter. */
  async ask(size: Size | null): Promise<void> {
    const { sheet } = this;
    const gait = sentGait(sheet, this.robot);
    const rows = sheet.sequence.peek();
    if (!gait || !rows) {
      void this.trials.tryIt(); // says what is missing
      return;
    }
    const version = sheet.version.peek();
    this.others.looks.value = null;
    this.found.value = null;
    this.revealed.value = false;
    const goal = this.goal.peek();
    const fields = {
      key: sheet.key.peek(),
      goal,
      size,
      seconds: SECONDS,
      seed: 0,
    };
    const reply = await this.search.ask<CoachReply>("coach", { ...gait, ...fields });
    if (reply) this.found.value = { reply, version, rows, size, goal };
  }

  /** Put the better gait into the table, in one step, and let it walk. */
  apply({ reply, rows, size }: Found): void {
    this.sheet.edit(
      t("design.step.coach"),
      (now) => changed(now, rows, reply.changes),
      null,
      "coach",
      size,
    );
    this.found.value = null;
    void this.trials.tryIt();
  }

  private marksSeen(): ReadonlyMap<number, ReadonlyMap<number, Marked>> | null {
    const now = this.found.value;
    if (!now || !this.revealed.value || now.size !== null) return null;
    if (now.version !== this.sheet.version.value) return null;
    const most = Math.max(1, ...now.reply.matters.map(strength));
    const marks = new Map<number, Map<number, Marked>>();
    for (const one of now.reply.matters) {
      const { cell, up, down } = one;
      const row = now.rows[cell.posture];
      if (row === undefined || !isStrong(one)) continue;
      const ofRow = marks.get(row) ?? new Map<number, Marked>();
      marks.set(row, ofRow);
      const text = t("design.coach.mark", { up: signed(up), down: signed(down) });
      const share = Number((strength(one) / most).toFixed(3));
      const before = now.reply.score_before;
      const effects = { up: effectOf(up, before), down: effectOf(down, before) };
      ofRow.set(cell.joint, { share, ...effects, text });
    }
    return marks;
  }
}

type Turned = CoachReply["matters"][number];

/** Whether turning a number changes the score at all. */
export function isStrong(one: Turned): boolean {
  return strength(one) >= SMALL;
}

function strength({ up, down }: Turned): number {
  return Math.max(Math.abs(up), Math.abs(down));
}

/** Whether a change of the score is good; not if the robot does not walk with it either. */
export function effectOf(by: number, before: number): Effect {
  if (Math.abs(by) < SMALL || (by > 0 && before + by <= 0)) return "none";
  return by > 0 ? "good" : "bad";
}

/** A change of the score, with its sign. */
export function signed(by: number): string {
  return `${by < 0 ? "−" : "+"}${Math.abs(by).toFixed(1)}`;
}
