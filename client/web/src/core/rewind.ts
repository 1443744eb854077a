/** The last two minutes of a live match again: a match that is live, or some time behind. */

import { computed, type ReadonlySignal, signal } from "@preact/signals";
import type { Match } from "./match";
import { Playback } from "./playback";
import { countUntil } from "./recording";
import { type Moment, momentAt } from "./timeline";
import {
  BEATS_PER_S,
  type Event,
  type Frame,
  type HealthVerdict,
  type Scene,
  type Sheet,
} from "./wire";

/** How long frames are kept: the memory of a page is bounded, however long a match lasts. */
const KEPT_BEATS = 120 * BEATS_PER_S;
/** Nearer to the newest frame than this, what is shown is live. */
const LIVE_BEATS = BEATS_PER_S / 2;

export class Rewind implements Match {
  readonly sheet: ReadonlySignal<Sheet | null>;
  readonly scene: ReadonlySignal<Scene | null>;
  readonly frame: ReadonlySignal<Frame | null>;
  /** Those that have happened at the moment shown. */
  readonly events: ReadonlySignal<readonly Event[]>;
  readonly verdict: ReadonlySignal<HealthVerdict | null>;
  /** Whether something is shown that has passed. */
  readonly isBack = signal(false);
  /** How long ago the moment shown was [s]; 0: it is live. */
  readonly behindS: ReadonlySignal<number>;
  /** The beat that is shown, with its fraction, while it is not live. */
  readonly beat = signal(0);
  readonly playback = new Playback(this);
  private frames: Frame[] = [];
  private court: string | undefined;

  constructor(private readonly live: Match) {
    this.sheet = live.sheet;
    this.scene = live.scene;
    this.verdict = live.verdict;
    const whole = computed(() => Math.floor(this.beat.value));
    this.frame = computed(() => {
      const newest = live.frame.value;
      return this.isBack.value ? momentAt(this.frames, whole.value).before : newest;
    });
    const happened = computed(() => countUntil(live.events.value, whole.value));
    this.events = computed(() => {
      const all = live.events.value;
      return this.isBack.value ? all.slice(0, happened.value) : all;
    });
    this.behindS = computed(() => {
      const newest = live.frame.value?.beat ?? 0;
      return this.isBack.value ? Math.max(0, newest - this.beat.value) / BEATS_PER_S : 0;
    });
    live.frame.subscribe((frame) => this.keep(frame));
  }

  get firstBeat(): number {
    return this.frames[0]?.beat ?? 0;
  }

  get lastBeat(): number {
    return this.frames.at(-1)?.beat ?? 0;
  }

  sample(nowMs: number): Moment | null {
    return this.isBack.peek() ? momentAt(this.frames, this.beat.peek()) : this.live.sample(nowMs);
  }

  /** Go to a beat that is kept; near the newest one it is live again. */
  seek(beat: number): void {
    if (beat > this.lastBeat - LIVE_BEATS) this.goLive();
    else this.beat.value = Math.max(this.firstBeat, beat);
  }

  /** Go back, or forth, by a time [s]. */
  skip(seconds: number): void {
    const now = this.isBack.peek() ? this.beat.peek() : this.lastBeat;
    if (this.lastBeat - this.firstBeat < 2 * LIVE_BEATS) return;
    if (!this.isBack.peek()) {
      if (seconds > 0) return;
      this.beat.value = now;
      this.isBack.value = true;
      this.playback.play();
    }
    this.seek(now + seconds * BEATS_PER_S);
  }

  /** Play from a beat on at a speed. */
  from(beat: number, speed: number): void {
    this.skip((beat - this.lastBeat) / BEATS_PER_S);
    this.playback.speed.value = speed;
  }

  /** Stop the picture, or go on from there. */
  toggle(): void {
    if (!this.isBack.peek()) this.skip(-1);
    this.playback.toggle();
  }

  goLive(): void {
    this.playback.pause();
    this.playback.speed.value = 1;
    this.isBack.value = false;
  }

  private keep(frame: Frame | null): void {
    const newest = this.frames.at(-1);
    const court = this.live.sheet.peek()?.court;
    // Another match has another time. A director's cut shows another court, whose matches have the
    // same numbers.
    const isOther = newest && (frame?.match !== newest.match || frame.beat < newest.beat);
    if (!frame || isOther || court !== this.court) {
      this.frames = [];
      this.goLive();
    }
    this.court = court;
    if (!frame || frame.beat === this.frames.at(-1)?.beat) return;
    this.frames.push(frame);
    if (this.frames[0]!.beat < frame.beat - 1.1 * KEPT_BEATS) {
      const first = this.frames.findIndex(({ beat }) => beat >= frame.beat - KEPT_BEATS);
      this.frames = this.frames.slice(first);
      // Who stays behind for longer than that goes on at the oldest moment.
      if (this.beat.peek() < this.firstBeat) this.beat.value = this.firstBeat;
    }
  }
}
