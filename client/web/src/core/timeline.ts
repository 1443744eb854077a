/**
 * Which moment of a match is shown now.
 *
 * Frames arrive late, in bursts, or not at all; what is shown must move evenly. So a moment is
 * shown a little after it was: by as much as the frames' unevenness of the last seconds demands.
 * Beats say when a frame was; a beat takes 20 ms where the court keeps up, else it is estimated.
 */

import type { Frame } from "./wire.gen.ts";
import { BEATS_PER_S } from "./wire.gen.ts";

/** Between two frames; `part` 0 is `before`, 1 is `after`. */
export interface Moment {
  before: Frame;
  after: Frame;
  part: number;
  /** Beat shown, with its fraction. */
  beat: number;
}

const NOMINAL_BEATS_PER_MS = BEATS_PER_S / 1000;
/** A court can run slower than this or faster, but then nobody follows it by eye. */
const SLOWEST = 0.1;
const FASTEST = 40;

const LEAST_DELAY_MS = 30;
const MOST_DELAY_MS = 80;
const SPARE_MS = 6;

/** The arrivals that delay and rate are estimated from. */
const WINDOW_MS = 2500;
/** One arrival is kept in each: a burst counts once, with its newest frame. */
const BUCKET_MS = 40;
/** Number of kept arrivals over which slopes are computed. */
const SPAN = 12;
/** After a silence of this length the court's phase is unknown. */
const GAP_MS = 400;
/** A larger error of the shown time is corrected at once, a smaller one gradually. */
const SNAP_MS = 250;
const GENTLE_PER_MS = 1 / 300;
const GENTLE_MOST = 0.15;
/** Frames are kept for this time longer than the delay. */
const KEEP_MS = 1000;

interface Arrival {
  bucketMs: number;
  atMs: number;
  beat: number;
}

/** A frame, by its name. */
export interface Seen {
  match: number;
  beat: number;
}

/** Plays frames as they come. */
export class Timeline {
  private frames: Frame[] = [];
  private arrivals: Arrival[] = [];
  private latenesses: number[] = [];
  private lastArrivalMs = Number.NEGATIVE_INFINITY;
  private intervalMs = 1 / NOMINAL_BEATS_PER_MS;
  private rate = NOMINAL_BEATS_PER_MS;
  private adaptiveMs = LEAST_DELAY_MS + SPARE_MS;
  private shown = Number.NaN;
  private sampledMs = 0;

  /** Beats per ms of wall time. */
  get beatsPerMs(): number {
    return this.rate;
  }

  /** How long after its arrival a frame is shown, without the extra delay [ms]. */
  get delayMs(): number {
    return this.adaptiveMs;
  }

  /** Frames that are kept. */
  get length(): number {
    return this.frames.length;
  }

  /** The newest frame. */
  get newest(): Frame | null {
    return this.frames[this.frames.length - 1] ?? null;
  }

  /**
   * Take in a frame.
   *
   * @param frame As it arrived.
   * @param arrivedMs When it did, by `performance.now()`.
   */
  push(frame: Frame, arrivedMs: number): void {
    const newest = this.newest;
    if (newest && (frame.match !== newest.match || frame.beat < newest.beat)) this.reset();
    else if (newest && frame.beat === newest.beat) return;
    this.frames.push(frame);
    this.note(frame.beat, arrivedMs);
    const keep = frame.beat - (KEEP_MS + this.adaptiveMs) * this.rate;
    // Two frames stay whatever their age: a picture needs a before and an after.
    let drop = 0;
    while (drop < this.frames.length - 2 && this.frames[drop + 1]!.beat < keep) drop++;
    if (drop) this.frames.splice(0, drop);
  }

  /** The state to show now; null before the first frame. */
  sample(nowMs: number): Moment | null {
    const first = this.frames[0];
    const newest = this.newest;
    if (!first || !newest) return null;
    const target = this.due(nowMs);
    const passedMs = nowMs - this.sampledMs;
    this.sampledMs = nowMs;
    const behindMs = (target - this.shown) / this.rate - passedMs;
    // After a pause without pictures nobody sees a leap, either.
    if (!(Math.abs(behindMs) < SNAP_MS && passedMs < SNAP_MS)) this.shown = target;
    else {
      const hurry = Math.max(-GENTLE_MOST, Math.min(GENTLE_MOST, behindMs * GENTLE_PER_MS));
      this.shown += passedMs * this.rate * (1 + hurry);
    }
    // Never ahead of what is known: a guess would have to be taken back.
    this.shown = Math.min(newest.beat, Math.max(first.beat, this.shown));
    return momentAt(this.frames, this.shown);
  }

  /**
   * The newest frame that a person has seen whole; null before the first frame.
   *
   * Where nothing is drawn, as in a hidden tab, it is the one that would be shown now: frames come
   * there too, so such a page seems to be neither farther nor nearer.
   */
  seen(nowMs: number): Seen | null {
    const first = this.frames[0];
    const newest = this.newest;
    if (!first || !newest) return null;
    const isDrawn = nowMs - this.sampledMs < SNAP_MS && !Number.isNaN(this.shown);
    const beat = isDrawn ? this.shown : this.due(nowMs);
    const whole = Math.floor(Math.min(newest.beat, Math.max(first.beat, beat)));
    return { match: newest.match, beat: whole };
  }

  /** Forget everything. */
  reset(): void {
    this.frames = [];
    this.arrivals = [];
    this.latenesses = [];
    this.lastArrivalMs = Number.NEGATIVE_INFINITY;
    this.rate = NOMINAL_BEATS_PER_MS;
    this.adaptiveMs = LEAST_DELAY_MS + SPARE_MS;
    this.shown = Number.NaN;
  }

  /** The beat whose turn it is now, before small errors are evened out. */
  private due(nowMs: number): number {
    return this.head(nowMs) - this.adaptiveMs * this.rate;
  }

  /** The beat that the court is at now, as the most punctual of the arrivals have it. */
  private head(nowMs: number): number {
    let head = Number.NEGATIVE_INFINITY;
    for (const { atMs, beat } of this.arrivals) {
      head = Math.max(head, beat + (nowMs - atMs) * this.rate);
    }
    return head;
  }

  private note(beat: number, arrivedMs: number): void {
    const sinceMs = arrivedMs - this.lastArrivalMs;
    this.lastArrivalMs = arrivedMs;
    if (sinceMs > GAP_MS) {
      this.arrivals = [];
      this.latenesses = [];
    } else this.intervalMs += (sinceMs - this.intervalMs) * 0.05;
    const bucketMs = Math.floor(arrivedMs / BUCKET_MS);
    const last = this.arrivals[this.arrivals.length - 1];
    if (last?.bucketMs === bucketMs) {
      last.atMs = arrivedMs;
      last.beat = beat;
    } else {
      this.arrivals.push({ bucketMs, atMs: arrivedMs, beat });
      if (arrivedMs - this.arrivals[0]!.atMs > WINDOW_MS) this.arrivals.shift();
      this.estimateRate();
    }
    this.latenesses.push((this.head(arrivedMs) - beat) / this.rate);
    if (this.latenesses.length > 120) this.latenesses.shift();
    this.adapt();
  }

  /** The median of many slopes: a stall or a burst spoils some of them, not their middle. */
  private estimateRate(): void {
    const slopes: number[] = [];
    for (let index = SPAN; index < this.arrivals.length; index++) {
      const from = this.arrivals[index - SPAN]!;
      const to = this.arrivals[index]!;
      slopes.push((to.beat - from.beat) / (to.atMs - from.atMs));
    }
    if (slopes.length < SPAN) return;
    slopes.sort((one, other) => one - other);
    const rate = slopes[slopes.length >> 1]! / NOMINAL_BEATS_PER_MS;
    // Near enough to real time is real time: a steady pace looks better than an exact one.
    const steady = Math.abs(rate - 1) < 0.03 ? 1 : rate;
    this.rate = NOMINAL_BEATS_PER_MS * Math.min(FASTEST, Math.max(SLOWEST, steady));
  }

  /** Wait for nearly all frames: one interval for the next frame, and what they are late by. */
  private adapt(): void {
    const sorted = [...this.latenesses].sort((one, other) => one - other);
    const late = sorted[Math.floor(0.95 * (sorted.length - 1))] ?? 0;
    const wanted = this.intervalMs + late + SPARE_MS;
    const most = Math.max(MOST_DELAY_MS, this.intervalMs + 2 * SPARE_MS);
    const goal = Math.min(most, Math.max(LEAST_DELAY_MS, wanted));
    // Up fast, down slowly: a stutter is worse than a few milliseconds.
    this.adaptiveMs += (goal - this.adaptiveMs) * (goal > this.adaptiveMs ? 0.3 : 0.01);
  }
}

/** The frames of a recording: any moment of them can be shown. */
export class Track {
  readonly frames: readonly Frame[];

  /** @param frames In the order of their beats. */
  constructor(frames: readonly Frame[]) {
    this.frames = frames;
  }

  get firstBeat(): number {
    return this.frames[0]?.beat ?? 0;
  }

  get lastBeat(): number {
    return this.frames[this.frames.length - 1]?.beat ?? 0;
  }

  /** The state at a beat, limited to the recording; null if it has no frames. */
  sampleAt(beat: number): Moment | null {
    if (!this.frames.length) return null;
    return momentAt(this.frames, Math.min(this.lastBeat, Math.max(this.firstBeat, beat)));
  }
}

/** The moment of a beat between the first and the last of some frames. */
export function momentAt(frames: readonly Frame[], beat: number): Moment {
  let low = 0;
  let high = frames.length - 1;
  while (low < high) {
    const middle = (low + high + 1) >> 1;
    if (frames[middle]!.beat <= beat) low = middle;
    else high = middle - 1;
  }
  const before = frames[low]!;
  const after = frames[low + 1] ?? before;
  const span = after.beat - before.beat;
  const part = span > 0 ? Math.min(1, Math.max(0, (beat - before.beat) / span)) : 0;
  return { before, after, part, beat };
}
