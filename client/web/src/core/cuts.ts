/** What a page says of a director's cuts: it may not have seen what was on air before. Pure. */

import { Phase } from "./wire.gen";

/** What the director shows, and why. */
export interface Cut {
  court: string;
  /** Name of a message `director.why.…`. */
  why: string;
}

/** Remembers which court was seen last, and whether the reason for a cut still holds. */
export class Cuts {
  private court = "";
  private reason = "";
  private seen = "";
  private sawBefore = false;
  private wasPlayed = false;
  /** Whether the play that was cut to has ended: what was said of it is not true any more. */
  private isPast = false;

  /**
   * Why a court is on air, as far as its viewers can know it, and while it is true; else "".
   *
   * @param isSeen Whether the page shows the picture now: a projector shows tables at times.
   * @param phase The phase of the match on air; CREATED if that is not known.
   */
  why({ court, why }: Cut, isSeen: boolean, phase: number): string {
    if (court !== this.court) this.sawBefore = this.seen !== "" && this.seen === this.court;
    if (court !== this.court || why !== this.reason) {
      [this.court, this.reason] = [court, why];
      this.wasPlayed = this.isPast = false;
    }
    if (isSeen) this.seen = court;
    if (phase >= Phase.COUNTDOWN && phase <= Phase.HALTED) this.wasPlayed = true;
    else if (phase !== Phase.CREATED) this.isPast ||= this.wasPlayed;
    return this.isPast || (why === "gone" && !this.sawBefore) ? "" : why;
  }
}
