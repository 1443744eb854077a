/** Before a match: the own robot stands alone on the field, and walks by the keys that are tried. */

import { computed, effect, type ReadonlySignal, signal, untracked } from "@preact/signals";
import { type Refused, Unanswered } from "./connection";
import type { Court } from "./court";
import { jointsPerSeat, poseStarts } from "./fk";
import type { Phrase } from "./phrase";
import type { Player } from "./player";
import { type Moment, momentAt } from "./timeline";
import {
  BEATS_PER_S,
  type Frame,
  Phase,
  RESTART_KEY,
  type Scene,
  SeatFlag,
  type Sheet,
  TRY_OUT_ASKED_TICKS,
  TRY_OUT_KEYS,
  TRY_OUT_TICKS,
  type TryOutReply,
} from "./wire";

/** So long the robot takes to stand as before a match [ticks]. */
const STAND_TICKS = 50;
/** The next pictures are asked for so long before the last one is shown [ticks]. */
const AHEAD_TICKS = 75;
/** Least time between two questions: a court answers some of them a second. */
const PACE_MS = 350;
const AGAIN_MS = 1000;

/** Tick, level, key. */
type Tried = readonly [tick: number, level: number, key: number];

/** What the field shows: the match, or before it the own robot as its court lets it walk. */
export class TryOut {
  readonly sheet: ReadonlySignal<Sheet | null>;
  readonly scene: ReadonlySignal<Scene | null>;
  /** Whether keys are tried, and do not go to the match. */
  readonly isOpen: ReadonlySignal<boolean>;
  /** The key that the robot walks by, as the pad shows it; null: none. */
  readonly standing: ReadonlySignal<{
    level: number;
    key: number;
    posture: number;
    count: number;
    begun: boolean;
  } | null>;
  private readonly keys = signal<readonly Tried[]>([]);
  /** The field with the own robot alone; null until the court has answered. */
  private readonly alone = signal<{ hash: Uint8Array; scene: Scene } | null>(null);
  private readonly isShown: ReadonlySignal<boolean>;
  private frames: Frame[] = [];
  /** The pictures are right up to this tick. */
  private known = 0;
  private beganMs = 0;
  private asking = false;
  /** The robot walks no further than what is known: physics stopped there. */
  private stopped = false;
  private isWanted = false;
  /** Counts the robots that were seen: an answer about an earlier one is of no use. */
  private robots = 0;

  /** @param say Told why a key was not tried. */
  constructor(
    private readonly court: Court,
    private readonly player: Player,
    private readonly say: (why: Phrase) => void,
  ) {
    const isLobby = computed(
      () => court.frame.value?.phase === Phase.LOBBY && court.seat.value?.hold === "held",
    );
    const isReady = player.part((seat) => Boolean(seat.flags & SeatFlag.READY), false);
    this.isShown = computed(() => isLobby.value && this.alone.value !== null);
    this.isOpen = computed(() => this.isShown.value && !isReady.value);
    this.sheet = computed(() => {
      const sheet = court.sheet.value;
      return this.isShown.value && sheet ? { ...sheet, scene: this.alone.value!.hash } : sheet;
    });
    this.scene = computed(() => (this.isShown.value ? this.alone.value!.scene : court.scene.value));
    this.standing = computed(() => {
      const [, level, key] = this.keys.value.at(-1) ?? [];
      if (!this.isOpen.value || level === undefined || key === undefined) return null;
      return { level, key, posture: 0, count: 0, begun: true };
    });
    // Another robot or another gait: from the beginning.
    const robot = computed(() => {
      const { seats = [], match } = court.sheet.value ?? {};
      const seat = player.index.value;
      if (!isLobby.value || !seats[seat]?.robot) return "";
      // Files may differ though their names do not: whoever brings others joins again.
      const joins = court.events.value.filter((one) => one.kind === "join" && one.seat === seat);
      return JSON.stringify([match, seats[seat], jointsPerSeat(court.sheet.value!), joins.length]);
    });
    effect(() => {
      this.isWanted = robot.value !== "";
      untracked(() => {
        this.robots++;
        this.alone.value = null;
        this.frames = [];
        this.restart();
      });
    });
    effect(() => {
      if (isReady.value) untracked(() => this.restart());
    });
  }

  sample(nowMs: number): Moment | null {
    if (!this.isShown.peek()) return this.court.sample(nowMs);
    const tick = this.tick(nowMs);
    if (tick >= (this.stopped ? this.known : TRY_OUT_TICKS)) this.restart();
    else if (this.keys.peek().length && this.known - tick < AHEAD_TICKS) void this.ask();
    return this.frames.length ? momentAt(this.frames, tick) : null;
  }

  /** Let the robot walk by a key, or put it back to its start. */
  press(level: number, key: number): void {
    if (key === RESTART_KEY) {
      this.restart();
      return;
    }
    const { value: keys } = this.keys;
    const last = keys.at(-1)?.[0] ?? -1;
    const tick = Math.max(last + 1, Math.ceil(this.tick(performance.now())));
    if (tick >= TRY_OUT_TICKS || keys.length === TRY_OUT_KEYS) this.restart();
    else {
      this.keys.value = [...keys, [tick, level, key]];
      this.known = Math.min(this.known, tick);
      this.stopped = false;
      void this.ask();
    }
  }

  /** The robot stands at its start again. */
  private restart(): void {
    const moved = this.keys.peek()[0]?.[0] ?? TRY_OUT_TICKS;
    this.keys.value = [];
    this.frames = this.frames.filter(({ beat }) => beat <= moved);
    this.known = this.frames.at(-1)?.beat ?? 0;
    this.beganMs = performance.now();
    this.stopped = false;
    void this.ask();
  }

  /** The tick that is shown now: never one that is not known. */
  private tick(nowMs: number): number {
    const last = this.frames.at(-1)?.beat ?? 0;
    const tick = ((nowMs - this.beganMs) * BEATS_PER_S) / 1000;
    if (tick > last) this.beganMs = nowMs - (last * 1000) / BEATS_PER_S;
    return Math.max(0, Math.min(last, tick));
  }

  private async ask(): Promise<void> {
    const { robots, known: first } = this;
    const keys = this.keys.peek();
    const most = keys.length ? TRY_OUT_TICKS : STAND_TICKS;
    if (this.asking || !this.isWanted || this.stopped || first >= most) return;
    this.asking = true;
    const until = Math.min(most, first + TRY_OUT_ASKED_TICKS);
    const fields = { keys, first, until, drawn: !this.alone.peek() };
    const paced = new Promise((resolve) => setTimeout(resolve, PACE_MS));
    let goesOn = true;
    let isLate = false;
    try {
      const reply = await this.court.ask<TryOutReply>("try", fields);
      if (robots === this.robots) this.take(reply, keys, until);
    } catch (error) {
      const { why, again } = error as Refused;
      isLate = again || error instanceof Unanswered || why.code === "page.not-connected";
      if (isLate) await new Promise((resolve) => setTimeout(resolve, AGAIN_MS));
      else if (keys.length && keys === this.keys.peek()) {
        this.say(why);
        this.known = Math.min(this.known, keys.at(-1)![0]);
        this.keys.value = keys.slice(0, -1);
      } else goesOn = robots !== this.robots;
    }
    await paced;
    this.asking = false;
    const isOther = keys !== this.keys.peek() || robots !== this.robots || !this.alone.peek();
    if (goesOn && (isLate || isOther)) void this.ask();
  }

  /** Take pictures, unless other keys were pressed meanwhile. */
  private take(reply: TryOutReply, keys: readonly Tried[], until: number): void {
    if (reply.drawn) this.alone.value = { hash: reply.scene, scene: reply.drawn };
    const frame = this.court.frame.peek();
    const sheet = this.court.sheet.peek();
    if (keys !== this.keys.peek() || !frame || !sheet) return;
    const starts = poseStarts(jointsPerSeat(sheet));
    const made = reply.poses.map((poses, index) => {
      const all = new Uint8Array(4 * starts.at(-1)!);
      all.set(poses, 4 * starts[this.player.index.peek()]!);
      const beat = reply.first + index * reply.every;
      return { ...frame, beat, poses: all, scene: reply.scene };
    });
    this.frames = [...this.frames.filter(({ beat }) => beat < reply.first), ...made];
    this.known = this.frames.at(-1)?.beat ?? 0;
    this.stopped = keys.length > 0 && this.known + reply.every < until;
  }
}
