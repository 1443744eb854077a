/** The six phases: how far the student is, and what is sent as evidence (workshop 4-2). */

import { signal } from "@preact/signals";
import type { Judged, Phases } from "../../../core/wire";
import type { SentGait } from "../files/gait";
import type { Gateway } from "../gateway";
import type { By } from "../table/sheet";

/** Edits of the same kind within this time are told as one. */
const TELL_MS = 250;

export class Learning {
  /** How far the student is; null: not known yet. */
  readonly phases = signal<Phases | null>(null);
  /** Where the student says that a foot goes with the next edit. */
  readonly footGuess = signal<string | null>(null);
  /** What came of the last such guess. */
  readonly judged = signal<Judged | null>(null);
  /** The edits that the gateway does not know yet; null: none. */
  private untold: { by: By; size: string | null; timer: number } | null = null;
  private greeted = false;

  /** @param gait The table as it is now; null while a cell has no angle. */
  constructor(
    private readonly gateway: Gateway,
    readonly gait: () => SentGait | null,
  ) {}

  /** The gateway knows this page, and may take evidence. */
  greet(): void {
    this.greeted = true;
    if (this.gait()) this.edited(null);
  }

  /** Go to a phase, forward or back. */
  async goTo(number: number): Promise<void> {
    await this.send("phase", { number });
  }

  /** Send something that counts as evidence; null: it was refused. */
  async send<T>(what: "phase" | "name" | "vote" | "check", fields: object): Promise<T | null> {
    this.tell();
    try {
      return await this.gateway.ask<T>(what, fields);
    } catch (error) {
      this.gateway.refuse(error);
      return null;
    }
  }

  /** Tell the gateway of an edit, after a moment in which more of the same kind may come. */
  edited(by: By, size: string | null = null): void {
    if (this.untold) clearTimeout(this.untold.timer);
    // What could not be told yet, because a cell has no angle, is told with this.
    const first = this.untold ?? { by, size };
    const timer = window.setTimeout(() => this.tell(), TELL_MS);
    this.untold = { ...first, timer };
  }

  /**
   * Tell the gateway of the edits that it does not know yet.
   *
   * @param butBy Edits made in this way may wait.
   */
  tell(butBy?: By): void {
    const { untold } = this;
    if (!untold || untold.by === butBy || !this.greeted) return;
    const gait = this.gait();
    if (!gait) return;
    clearTimeout(untold.timer);
    this.untold = null;
    const guess = untold.by === "hand" ? this.footGuess.peek() : null;
    if (guess) this.footGuess.value = null;
    const { by, size } = untold;
    const fields = { ...gait, by, size, guess };
    this.gateway.ask<{ guess: Judged | null }>("edit", fields).then(
      (reply) => {
        if (guess) this.judged.value = reply.guess;
      },
      // The next edit tells it, or the next connection.
      () => {},
    );
  }
}
