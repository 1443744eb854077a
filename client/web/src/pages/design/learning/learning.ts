/** The phases: how far the student is, and what is sent as evidence (workshop 3-1, 4-2). */

import { signal } from "@preact/signals";
import { Unanswered } from "../../../core/connection";
import { changesBetween } from "../../../core/design/rebase";
import { mapRows, type Table, toWire, withCells, wrongOf } from "../../../core/design/table";
import type { AnswerReply, FileTable, Judged, Phases } from "../../../core/wire";
import type { SentGait } from "../files/gait";
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

/** An edit as it is told. */
interface ToldEdit extends SentGait {
  before: FileTable;
  by: By;
  size: string | null;
  guess: string | null;
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
  /** The table without what is untold; others' changes are in it. null: none is there yet. */
  private before: Table | null = null;
  /** Edits whose reply is not there yet, in order. */
  private readonly asked = new Set<ToldEdit>();
  private greeted = false;

  /**
   * @param gait The table as it is now; null while a cell has no angle.
   * @param table The table as it is now.
   */
  constructor(
    private readonly gateway: Gateway,
    readonly gait: () => SentGait | null,
    private readonly table: () => Table | null,
  ) {}

  /** The gateway knows this page and its student, and may take evidence. */
  greet(): void {
    this.greeted = true;
    for (const edit of this.asked) this.ask(edit);
    this.tell();
  }

  /** Take in that others have changed the table: that is no edit of this student. */
  merged(from: Table, to: Table): void {
    if (this.before) this.before = changesBetween(from, to)(this.before);
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
    // What could not be told yet, because a cell has no angle, is told with what comes now.
    const first = this.untold ?? (by && { by, size });
    if (this.untold) clearTimeout(this.untold.timer);
    if (!first || !this.before) {
      this.before = this.table();
      return;
    }
    const timer = window.setTimeout(() => this.tell(), TELL_MS);
    this.untold = { by: first.by, size: first.size, timer };
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
    const now = this.table();
    if (!gait || !now || !this.before) return;
    clearTimeout(untold.timer);
    this.untold = null;
    const before = toWire(filled(this.before, now)) ?? gait.table;
    this.before = now;
    const guess = untold.by === "hand" ? this.footGuess.peek() : null;
    if (guess) this.footGuess.value = null;
    const edit = { ...gait, before, by: untold.by, size: untold.size, guess };
    this.asked.add(edit);
    this.ask(edit);
  }

  private ask(edit: ToldEdit): void {
    this.gateway.ask<{ guess: Judged | null }>("edit", edit).then(
      (reply) => {
        if (edit.guess) this.judged.value = reply.guess;
        this.settle(edit);
      },
      (error: unknown) => {
        // Without an answer it is told again by the next connection.
        const isLost = error instanceof Unanswered || !this.gateway.state.peek().open;
        if (!isLost) this.settle(edit);
      },
    );
  }

  private settle(edit: ToldEdit): void {
    this.asked.delete(edit);
    this.isTold.value = !this.untold && !this.asked.size;
  }
}

/** A table whose cells without an angle have those of another one. */
function filled(table: Table, from: Table): Table {
  return mapRows(table, (row) => {
    const other = from.rows.find(({ key, posture }) => key === row.key && posture === row.posture);
    return withCells(row, (cell, col) =>
      wrongOf(cell) === null ? cell : (other?.cells[col] ?? cell),
    );
  });
}
