/** The data that a page shows of a match, live or recorded, as signals. */

import { computed, type ReadonlySignal } from "@preact/signals";
import type { Moment } from "./timeline";
import {
  type Event,
  type Frame,
  type HealthVerdict,
  Phase,
  type Scene,
  type Sheet,
  unpackStates,
} from "./wire";

/** A match that every view can show. */
export interface Match {
  readonly sheet: ReadonlySignal<Sheet | null>;
  /** The drawable model that belongs to the sheet; null until it is here. */
  readonly scene: ReadonlySignal<Scene | null>;
  readonly frame: ReadonlySignal<Frame | null>;
  readonly events: ReadonlySignal<readonly Event[]>;
  /** How the match has been held so far; null: nothing is known of that. */
  readonly verdict: ReadonlySignal<HealthVerdict | null>;
  /** What to draw at a time of `performance.now()`; null before the first frame. */
  sample(nowMs: number): Moment | null;
}

/** The states of the markers, as a signal that changes only when one of them does. */
export function markerStates(match: Match): ReadonlySignal<readonly number[]> {
  let last: readonly number[] = [];
  return computed(() => {
    const frame = match.frame.value;
    const count = match.sheet.value?.markers.length ?? 0;
    if (!frame || frame.markers.length * 4 < count) return last;
    const states = unpackStates(frame.markers, count);
    if (states.length !== last.length || states.some((state, index) => state !== last[index])) {
      last = states;
    }
    return last;
  });
}

/** A part of the newest frame, as a signal that changes only when the part does. */
export function part<T extends string | number | boolean | null>(
  match: Match,
  of: (frame: Frame) => T,
  otherwise: T,
): ReadonlySignal<T> {
  return computed(() => {
    const frame = match.frame.value;
    return frame ? of(frame) : otherwise;
  });
}

/** The phase of a match; CREATED before its first frame. */
export function phaseOf(match: Match): ReadonlySignal<number> {
  return part(match, (frame) => frame.phase, Phase.CREATED);
}

/** The points of all seats, parted by spaces, so that it changes only when they do. */
export function scoresOf(match: Match): ReadonlySignal<string> {
  return part(match, (frame) => frame.seats.map((seat) => seat.score).join(" "), "");
}
