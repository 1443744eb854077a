/** Compares guesses that were made before a trial with what the trial shows. */

import { SAME_MM_S, SAME_SHARE, STRAIGHT_DEG_S } from "../wire";
import { figure } from "./trial";

export type Pace = "faster" | "slower" | "same";
export type Way = "left" | "right" | "straight";
export type Guess = { about: "pace"; is: Pace } | { about: "way"; is: Way };

export interface Verdict {
  right: boolean;
  /** The right answer. */
  was: Pace | Way;
}

type Figures = Record<string, unknown>;

/**
 * Whether a gait became faster forward; null if a trial has no speed.
 *
 * @param before Figures of the trial before the change.
 * @param after Figures of the trial after it.
 */
export function paceOf(before: Figures, after: Figures): Pace | null {
  const [was, is] = [figure(before, "speed_mm_s"), figure(after, "speed_mm_s")];
  if (was === null || is === null) return null;
  const by = is - was;
  if (Math.abs(by) < Math.max(SAME_MM_S, SAME_SHARE * Math.abs(was))) return "same";
  return by > 0 ? "faster" : "slower";
}

/** To which side a robot turns; null if the trial has no turning speed. */
export function wayOf(figures: Figures): Way | null {
  const drift = figure(figures, "drift_deg_s");
  if (drift === null) return null;
  if (Math.abs(drift) <= STRAIGHT_DEG_S) return "straight";
  return drift > 0 ? "left" : "right";
}

/** Compare a guess with what happened; null if the trials can't decide it. */
export function verdict(guess: Guess, before: Figures | null, after: Figures): Verdict | null {
  const was = guess.about === "way" ? wayOf(after) : before && paceOf(before, after);
  return was && { right: was === guess.is, was };
}
