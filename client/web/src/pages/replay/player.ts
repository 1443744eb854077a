/** Plays a recording, with the ways to another moment of the match. */

import { type Signal, signal } from "@preact/signals";
import { chancesOf } from "../../core/chance";
import type { Odds } from "../../core/odds";
import { Playback } from "../../core/playback";
import type { Recording } from "../../core/recording";
import type { Event } from "../../core/wire";
import { BEATS_PER_S } from "../../i18n/words";
import { isScoring, isTold } from "../../ui/thirds";

export const SPEEDS = [0.25, 0.5, 1, 2, 4, 8] as const;

/** A jump to an event goes to this long before it, so that it is seen happening. */
const RUN_UP_BEATS = BEATS_PER_S;
/** For this long after a jump to an event, "previous event" means the one before that event. */
const JUST_BEATS = 1.5 * BEATS_PER_S;

export class Player extends Playback {
  /** The events that one jumps to, and that have a mark. */
  readonly marks: readonly Event[];

  /** By score and clock, until those that bots have played are here; null: there are none. */
  readonly odds: Signal<Odds | null>;
  /** What is shown beside the recording, at the same beat: the match that it is a fork of. */
  readonly beside = signal<Recording | null>(null);

  constructor(readonly recording: Recording) {
    super(recording);
    const moments = chancesOf(recording.record);
    this.odds = signal(moments.length > 1 ? { by: "score", moments } : null);
    const { firstBeat, lastBeat } = recording;
    this.marks = recording.record.events.filter(
      (event) => event.beat >= firstBeat && event.beat <= lastBeat && isMarked(event),
    );
  }

  /** Go on by some seconds of the match. */
  skip(seconds: number): void {
    this.seek(this.recording.beat.value + seconds * BEATS_PER_S);
  }

  faster(steps: number): void {
    const index = SPEEDS.indexOf(this.speed.value as (typeof SPEEDS)[number]) + steps;
    this.speed.value = SPEEDS[Math.min(SPEEDS.length - 1, Math.max(0, index))]!;
  }

  /** Go to the next or the previous mark: to a moment before it, so that it is seen happening. */
  jump(direction: 1 | -1): void {
    const now = this.recording.beat.value;
    const ahead = now + RUN_UP_BEATS;
    const found =
      direction > 0
        ? this.marks.find(({ beat }) => beat > ahead + 1)
        : this.marks.findLast(({ beat }) => beat < ahead - JUST_BEATS);
    if (found) this.show(found);
    else this.seek(direction > 0 ? this.recording.lastBeat : this.recording.firstBeat);
  }

  /** Go to where an event can be seen happening. */
  show(event: Event): void {
    this.seek(event.beat - RUN_UP_BEATS);
  }
}

function isMarked(event: Event): boolean {
  const begins = event.kind === "phase" && ["PLAYING", "FINISHED"].includes(`${event.data.after}`);
  return isScoring(event) || isTold(event) || begins;
}
