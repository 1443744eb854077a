/** The phases: how far the student is, and what is sent as evidence (workshop 3-1, 4-2). */

import { signal } from "@preact/signals";
import type { AnswerReply, Judged, Phases } from "../../../core/wire";
import type { Base, SentGait } from "../files/gait";
import type { Gateway } from "../gateway";
import type { By } from "../table/sheet";

/** Edits of the same kind within this time are told as one. */
const TELL_MS = 250;

/** The phase after which the sample gait is the reward. */
const REWARDED = 4;

/** Whether a student has earned the sample gait. */
export function hasEarned({ phases }: Phases): boolean {
  return phases[REWARDED]?.state === "met";
}

/** An answer to the question of a phase, and what came of it. */
export interface PhaseAnswer extends AnswerReply {
  phase: number;
}

/** The edits that the gateway does not know yet. */
interface Untold {
  by: By;
  size: string | null;
  timer: number;
}

export class Learning {
  /** How far the student is; null: not known yet. */
  readonly phases = signal<Phases | null>(null);
  /** Where the student says that a foot goes with the next edit. */
  readonly footGuess = signal<string | null>(null);
  /** What came of the last such guess. */
  readonly judged = signal<Judged | null>(null);
  /** What came of the last answer to a phase's question; null: none was given here. */
  readonly answer = signal<PhaseAnswer | null>(null);
  /** Whether the gateway has the table as it is now. */
  readonly isTold = signal(true);
  private untold: Untold | null = null;
  /** Count of edits whose reply is not there yet. */
  private asked = 0;
  /** The table that the gateway is known to have; null: none. */
  private known: (SentGait & Base) | null = null;
  private greeted = false;

  /**
   * @param gait The table as it is now; null while a cell has no angle.
   * @param base What is told of its file.
   */
  constructor(
    private readonly gateway: Gateway,
    readonly gait: () => SentGait | null,
    private readonly base: () => Base,
  ) {}

  /** The gateway knows this page and its student, and may take evidence. */
  greet(): void {
    this.greeted = true;
    // A new connection compares an edit with what came before it: what was changed meanwhile counts.
    if (this.known && this.untold) {
      this.gateway.ask("edit", { ...this.known, by: null }).catch(() => undefined);
    }
    this.edited(null);
    this.tell();
  }

  /** Go to a phase, forward or back. */
  async goTo(number: number): Promise<void> {
    await this.send("phase", { number });
  }

  /** Answer the question of a phase. */
  async say(phase: number, question: string, choice: number): Promise<void> {
    const reply = await this.send<AnswerReply>("answer", { phase, question, choice });
    if (reply) this.answer.value = { ...reply, phase };
  }

  /** Send something that counts as evidence; null: it was refused. */
  async send<T>(
    what: "phase" | "answer" | "name" | "vote" | "check" | "hand",
    fields: object,
  ): Promise<T | null> {
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
    const first = this.untold?.by ? this.untold : { by, size };
    const timer = window.setTimeout(() => this.tell(), TELL_MS);
    this.untold = { ...first, timer };
    this.isTold.value = false;
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
    const told = { ...gait, ...this.base() };
    this.asked += 1;
    this.gateway.ask<{ guess: Judged | null }>("edit", { ...told, by, size, guess }).then(
      (reply) => {
        if (guess) this.judged.value = reply.guess;
        this.known = told;
        this.asked -= 1;
        this.isTold.value = !this.untold && !this.asked;
      },
      () => {
        // The next edit tells it, or the next connection.
        this.asked -= 1;
        this.untold ??= untold;
      },
    );
  }
}
