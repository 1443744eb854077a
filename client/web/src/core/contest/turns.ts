/** What fills a projector: the picture of a match, or tables and what comes next. Pure. */

import { Phase } from "../wire";

/** The match in the director's picture. */
export interface OnAir {
  court: string;
  phase: number;
}

/** A link that breaks for a moment takes no picture away. */
const GRACE_MS = 5000;
/** How long an official result stays. */
const RESULT_MS = 10_000;
/** How long tables are shown after a match, while other courts play on: three slides. */
const BREAK_MS = 36_000;

const PLAYED = new Set<number>([
  Phase.READY,
  Phase.COUNTDOWN,
  Phase.PLAYING,
  Phase.HALTED,
  Phase.FINISHED,
]);
const DONE = new Set<number>([Phase.OFFICIAL, Phase.VOID]);

/** Decides it again and again; it remembers what was on air. */
export class Turns {
  private last: OnAir | null = null;
  private lastMs = 0;
  /** Since when the result on air is official; null: none is. */
  private doneMs: number | null = null;
  private breakEndsMs = 0;
  /** Whether the page came before the contest was over. */
  private cameInTime = false;

  /**
   * Whether the picture fills the screen now.
   *
   * @param nowMs The time.
   * @param live What is on air; null: no live picture.
   * @param isOver Whether the contest is over: whoever comes then sees who has won, and no match of
   *   before that courts and director still show.
   */
  isPicture(nowMs: number, live: OnAir | null, isOver = false): boolean {
    this.cameInTime ||= !isOver;
    if (!this.cameInTime) return false;
    const held = nowMs - this.lastMs < GRACE_MS ? this.last : null;
    const shown = live ?? held;
    if (live) {
      const before = this.last;
      const ended = before && (before.phase === Phase.FINISHED || DONE.has(before.phase));
      // With one court the next match must not begin behind a table.
      if (ended && before.court !== live.court) this.breakEndsMs = nowMs + BREAK_MS;
      this.last = live;
      this.lastMs = nowMs;
    }
    if (!shown) return false;
    if (!DONE.has(shown.phase)) this.doneMs = null;
    else this.doneMs ??= nowMs;
    if (this.doneMs !== null) return nowMs - this.doneMs < RESULT_MS;
    return PLAYED.has(shown.phase) && nowMs >= this.breakEndsMs;
  }
}
