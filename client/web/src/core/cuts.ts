/** What a page says of a director's cuts: it may not have seen what was on air before. Pure. */

/** What the director shows, and why. */
export interface Cut {
  court: string;
  /** Name of a message `director.why.…`. */
  why: string;
}

/** Remembers which court was seen last. */
export class Cuts {
  private court = "";
  private seen = "";
  private sawBefore = false;

  /**
   * Why a court is on air, as far as its viewers can know it; "" if they can't.
   *
   * @param isSeen Whether the page shows the picture now: a projector shows tables at times.
   */
  why({ court, why }: Cut, isSeen: boolean): string {
    if (court !== this.court) {
      this.sawBefore = this.seen !== "" && this.seen === this.court;
      this.court = court;
    }
    if (isSeen) this.seen = court;
    return why === "gone" && !this.sawBefore ? "" : why;
  }
}
