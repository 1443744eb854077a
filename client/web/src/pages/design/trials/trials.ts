/** Trials: what is pressed, what is foretold, and what came of it. */

import { batch, computed, signal } from "@preact/signals";
import { type Guess, verdict } from "../../../core/design/predict";
import { type Table, toWire } from "../../../core/design/table";
import { readTrial } from "../../../core/design/trial";
import type { TrialReply } from "../../../core/wire";
import { t } from "../../../i18n";
import { toast } from "../../../ui/toasts";
import { sentGait } from "../files/gait";
import type { Gateway } from "../gateway";
import type { Learning } from "../learning/learning";
import type { RobotInUse } from "../robot/robot";
import type { Sheet } from "../table/sheet";
import type { Showing } from "../walk/showing";
import { KeptTrials } from "./kept";
import type { Tried } from "./tried";

/** What can be tried of level A: a posture, or one posture after another. */
export const POSES = ["A1", "A1, A2"] as const;
export type Pose = (typeof POSES)[number];

/** The keys that a trial presses for this, for how long, and the posture that it measures. */
const PRESSED: Record<Pose, { keys: string; seconds: number; measured: number }> = {
  A1: { keys: "A1", seconds: 3, measured: 1 },
  "A1, A2": { keys: "A1:1, A2", seconds: 1.5, measured: 2 },
};
/** What a phase tries of level A. */
export const POSE_OF: Readonly<Record<number, Pose>> = { 2: "A1", 3: "A1, A2" };
const MOST_TRIALS = 40;
/** No table that was on the page has this version. */
const NO_VERSION = -1;

export class Trials {
  /** In the order in which they were made. */
  readonly all = signal<readonly Tried[]>([]);
  readonly trying = signal(false);
  /** What is pressed of level A instead of the chosen key; null: the key is. */
  readonly pose = signal<Pose | null>(null);
  /** What the next trial is foretold to do. */
  readonly guesses = signal<readonly Guess[]>([]);
  /** The row whose posture is the target at the moment shown; -1 if none is. */
  readonly target = computed(() => this.targetRow());
  /** Whether a trial was asked for while another one ran. */
  private again = false;
  /** Whether a trial was asked for while there was no connection. */
  private isDue = false;
  private readonly kept = new KeptTrials(MOST_TRIALS);

  constructor(
    private readonly gateway: Gateway,
    private readonly sheet: Sheet,
    private readonly robot: RobotInUse,
    private readonly learning: Learning,
    private readonly showing: Showing,
  ) {}

  /** Choose what the next trials press. */
  press(what: number | Pose): void {
    this.pose.value = typeof what === "number" ? null : what;
    if (typeof what === "number") this.sheet.key.value = what;
  }

  /** Choose what a phase tries: a key of level B, where it names no posture. */
  suit(phase: number): void {
    const isOfPostures = this.sheet.table.peek()?.kind === "postures";
    this.pose.value = (isOfPostures && POSE_OF[phase]) || null;
  }

  /** What the next trial presses. */
  pressed(): number | string {
    return this.pose.value ?? this.sheet.key.value;
  }

  /** Let the robot walk with the table as it is now. */
  async tryIt(): Promise<void> {
    const { gateway, sheet } = this;
    await this.robot.settled;
    const [table, robot] = [sheet.table.peek(), this.robot.robot.peek()];
    if (!table || !robot) return;
    if (this.trying.peek()) {
      this.again = true;
      return;
    }
    const gait = sentGait(sheet, this.robot);
    if (!gait) {
      sheet.select(sheet.bad.peek()[0]!);
      toast(t("design.badCells", { count: sheet.bad.peek().length }), "no");
      return;
    }
    const pose = this.pose.peek() && PRESSED[this.pose.peek()!];
    const rows = pose ? rowOf(table, pose.measured) : sheet.sequence.peek();
    const key = this.pressed();
    if (!rows) {
      toast(t("design.noSequence", { key }), "no");
      return;
    }
    this.trying.value = true;
    gateway.trouble.value = null;
    const version = sheet.version.peek();
    try {
      await this.learning.told();
      const reply = await gateway.ask<TrialReply>("trial", {
        ...gait,
        keys: pose ? pose.keys : String(key),
        seconds: pose ? pose.seconds : null,
        guesses: this.guesses.peek().map(({ about, is }) => ({ about, said: is })),
      });
      const trial = readTrial(reply, robot.legs.length);
      const number = (this.all.peek().at(-1)?.number ?? 0) + 1;
      const verdicts = this.judge(key, reply.figures);
      this.add({ number, name: "", version, table, key, rows, robot, trial, verdicts });
    } catch (error) {
      // What was asked for in an outage is done when the connection is back.
      this.isDue = !gateway.state.peek().open;
      if (this.isDue) toast(t("design.tryLater"));
      else gateway.refuse(error);
    } finally {
      this.trying.value = false;
      if (this.again) {
        this.again = false;
        void this.tryIt();
      }
    }
  }

  /** Make the trial that was asked for while there was no connection. */
  goOn(): void {
    if (!this.isDue) return;
    this.isDue = false;
    void this.tryIt();
  }

  /** Show how a table of the coach walks, beside the last trial of the key; it is no trial. */
  async watch(table: Table, rows: readonly number[], key: number, name: string): Promise<void> {
    const robot = this.robot.robot.peek();
    const [gait, wire] = [sentGait(this.sheet, this.robot), toWire(table)];
    if (!robot || !gait || !wire || this.trying.peek()) return;
    this.trying.value = true;
    try {
      const reply = await this.gateway.ask<TrialReply>("trial", {
        ...gait,
        table: wire,
        keys: String(key),
        watched: true,
      });
      const trial = readTrial(reply, robot.legs.length);
      const number = (this.all.peek().at(-1)?.number ?? 0) + 1;
      const tried = { number, name, version: NO_VERSION, table, key, rows, robot, trial };
      batch(() => {
        this.showing.look({ ...tried, verdicts: [] });
        this.showing.other.value = this.lastOf(key);
      });
    } catch (error) {
      this.gateway.refuse(error);
    } finally {
      this.trying.value = false;
    }
  }

  /** The last trial of a key: what the next one is compared with. */
  lastOf(key: number | string): Tried | null {
    return this.all.peek().findLast((tried) => tried.key === key) ?? null;
  }

  /** The trial that was made before the shown one; before any is shown, the last one. */
  beforeShown(): Tried | null {
    const now = this.showing.shown.value;
    return this.all.value.findLast((one) => !now || one.number < now.number) ?? null;
  }

  /** The trial before another one in which the same key was pressed: what its figures are compared with. */
  before({ number, key }: Tried): Tried | null {
    return this.all.value.findLast((one) => one.number < number && one.key === key) ?? null;
  }

  /** Put the table of a trial back, in one step. */
  restore(tried: Tried): void {
    const name = t("design.step.restore", { number: tried.number });
    this.sheet.put(name, tried.table, null);
  }

  /**
   * Bring the trials back that were made before the page was loaded, unless there are newer ones.
   *
   * @param whose Whose trials they are: a student's, or those of a folder.
   */
  async comeBack(whose: string): Promise<void> {
    const before = await this.kept.open(whose);
    const legs = this.robot.robot.peek()?.legs.length;
    if (this.all.peek().length || !before.length) return;
    if (before.some((tried) => tried.trial.legs !== legs)) await this.kept.clear();
    else this.all.value = before.map((tried) => ({ ...tried, version: NO_VERSION }));
  }

  /** Forget all trials: they are of another robot, or of a student who was forgotten. */
  forget(): void {
    this.all.value = [];
    this.showing.forget();
    void this.kept.clear();
  }

  private add(tried: Tried): void {
    batch(() => {
      this.guesses.value = [];
      // What was compared with a gait of the coach is compared no longer.
      if (this.showing.shown.peek()?.name) this.showing.other.value = null;
      this.all.value = [...this.all.peek(), tried].slice(-MOST_TRIALS);
      this.showing.look(tried);
    });
    void this.kept.add(tried);
  }

  private targetRow(): number {
    const { shown, watching, tick } = this.showing;
    const tried = shown.value;
    if (!tried || !watching.value || tried.version !== this.sheet.version.value) return -1;
    return tried.rows[tried.trial.posture[Math.floor(tick.value)] ?? -1] ?? -1;
  }

  private judge(key: number | string, after: Record<string, unknown>): Tried["verdicts"] {
    const before = this.lastOf(key)?.trial.reply.figures ?? null;
    return this.guesses.peek().flatMap((guess) => {
      const found = verdict(guess, before, after);
      return found ? [{ guess, verdict: found }] : [];
    });
  }
}

/** The row of a posture of level A; null if there is none. */
function rowOf(table: Table, key: number): number[] | null {
  const row = table.kind === "postures" ? table.rows.findIndex((one) => one.key === key) : -1;
  return row < 0 ? null : [row];
}
