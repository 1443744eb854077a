/** Keys on their way: from the press to the frame that shows the result. Pure. */

import type { SeatFrame } from "./wire";

/** So many keys are remembered. */
const REMEMBERED = 64;

/** The message about a key that the court refused. */
export interface RefusedKey {
  /** The court's number of the reason. */
  refused: number;
  key: number;
}

/** The keys that one controller sent; its sequence numbers tell which frame shows which key. */
export class SentKeys {
  private readonly sent = new Map<number, { key: number; atMs: number }>();
  /** Sequence numbers that frames have shown, and when: a reply may come after its frame. */
  private readonly shown: { seq: number; atMs: number }[] = [];
  private newest = 0;
  private reported = 0;

  /**
   * Take in the court's reply to a key: the key has this number.
   *
   * @returns The time that the key took [ms]; null if no frame has shown it yet.
   */
  add(seq: number, key: number, atMs: number): number | null {
    this.sent.set(seq, { key, atMs });
    if (this.sent.size > REMEMBERED) this.sent.delete(this.sent.keys().next().value!);
    const shown = this.shown.find((one) => one.seq >= seq);
    return shown ? this.tripMs(shown.seq, shown.atMs) : null;
  }

  /**
   * Take in the seat as a frame has it.
   *
   * @returns The time that the newest key took [ms]; null if the frame shows no key that is new.
   */
  see(seat: SeatFrame, nowMs: number): number | null {
    const seq = Math.max(seat.applied_seq, seat.refused_seq);
    if (seq <= this.newest) return null;
    this.newest = seq;
    this.shown.push({ seq, atMs: nowMs });
    if (this.shown.length > REMEMBERED) this.shown.shift();
    return this.tripMs(seq, nowMs);
  }

  /** Find the key that the court refused last; null if it was told already, or is not known yet. */
  refusal(seat: SeatFrame): RefusedKey | null {
    const sent = this.sent.get(seat.refused_seq);
    if (!sent || seat.refused_seq <= this.reported) return null;
    this.reported = seat.refused_seq;
    return { refused: seat.refused_why, key: sent.key };
  }

  private tripMs(seq: number, atMs: number): number | null {
    const sent = this.sent.get(seq);
    return sent ? Math.max(0, atMs - sent.atMs) : null;
  }
}
