/** What a page has done to a shared table, and the gateway has not confirmed yet. */

import { mergedUpdates } from "./shared_table";

/** What goes to the gateway at once. */
export interface Parcel {
  update: Uint8Array;
  /** Names of the entries that somebody changed. */
  names: string[];
  /** Whether it has what the page has put into an empty table: no other page may have been quicker. */
  begins: boolean;
  /** Number of the last update that the page had seen when this was sent first; null: it was not. */
  seen: number | null;
}

export class Outbox {
  private waiting: Parcel | null = null;
  private sent: Parcel | null = null;

  /** Whether the gateway has confirmed all. */
  get isEmpty(): boolean {
    return !this.waiting && !this.sent;
  }

  /** Names of the entries that were changed, and are not confirmed. */
  get names(): ReadonlySet<string> {
    return new Set([...(this.sent?.names ?? []), ...(this.waiting?.names ?? [])]);
  }

  /** Whether the gateway does not have yet what the page began the table with. */
  get begins(): boolean {
    return Boolean(this.sent?.begins || this.waiting?.begins);
  }

  add(update: Uint8Array, names: readonly string[], begins: boolean): void {
    // What a page begins with was typed by nobody.
    this.waiting = joined(this.waiting, {
      update,
      names: begins ? [] : [...names],
      begins,
      seen: null,
    });
  }

  /**
   * Take what waits, unless a parcel is on its way.
   * @param seen Number of the last update that the page has seen.
   */
  next(seen: number): (Parcel & { seen: number }) | null {
    if (this.sent || !this.waiting) return null;
    // What goes again was typed before the page saw what came in the break.
    const parcel = { ...this.waiting, seen: this.waiting.seen ?? seen };
    this.sent = parcel;
    this.waiting = null;
    return parcel;
  }

  /** The gateway has confirmed the parcel. */
  confirmed(): void {
    this.sent = null;
  }

  /** The parcel may not have come: it goes again, with what came since. */
  returned(): void {
    if (this.sent) this.waiting = joined(this.sent, this.waiting);
    this.sent = null;
  }

  /** Forget all. */
  clear(): void {
    this.sent = this.waiting = null;
  }
}

function joined(one: Parcel | null, other: Parcel | null): Parcel | null {
  if (!one || !other) return one ?? other;
  return {
    update: mergedUpdates([one.update, other.update]),
    names: [...new Set([...one.names, ...other.names])],
    begins: one.begins || other.begins,
    seen: one.seen,
  };
}
