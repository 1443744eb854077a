/** The phases: how far the student is, and what is sent as evidence (workshop 3-1, 4-2). */

import { signal } from "@preact/signals";
import { Refused, Unanswered } from "../../../core/connection";
import { changesBetween } from "../../../core/design/rebase";
import { mapRows, type Table, toWire, withCells, wrongOf } from "../../../core/design/table";
import type { AnswerReply, FileTable, Judged, Phases } from "../../../core/wire";
import type { SentGait } from "../files/gait";
import type { Gateway } from "../gateway";
import type { By } from "../table/sheet";

/** Edits of the same kind within this time are told as one. */
const TELL_MS = 250;
const ASK_AGAIN_MS = 2000;

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
  private readonly asked: ToldEdit[] = [];
  /** Ends when the gateway has all of them, or is away. */
  private asking: Promise<void> | null = null;
  private greeted = false;

  /**
   * @param gait The table as it is now, or another one; null while a cell has no angle.
   * @param table The table as it is now.
   */
  constructor(
    private readonly gateway: Gateway,
    readonly gait: (table?: Table) => SentGait | null,
    private readonly table: () => Table | null,
  ) {}

  /** The gateway knows this page and its student, and may take evidence. */
  greet(): void {
    this.greeted = true;
    this.tell();
    this.ask();
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
    await this.told();
    try {
      return await this.gateway.ask<T>(what, fields);
    } catch (error) {
      this.gateway.refuse(error);
      return null;
    }
  }

  /** Tell the gateway of an edit, after a moment in which more of the same kind may come. */
  edited(by: By, size: string | null = null): void {
    const { untold } = this;
    if (untold) clearTimeout(untold.timer);
    if (!by || !this.before) {
      this.untold = null;
      this.before = this.table();
      this.settle();
      return;
    }
    // What could not be told yet, because a cell has no angle, is told with what comes now. It is
    // typed only if both are.
    const first = untold && untold.by !== "hand" ? untold : { by, size };
    const timer = window.setTimeout(() => this.tell(), TELL_MS);
    this.untold = { by: first.by, size: first.size, timer };
    this.isTold.value = false;
  }

  /**
   * Tell the gateway of the edits that it does not know yet.
   *
   * A cell without an angle counts with the angle that it had, until it has another one.
   *
   * @param butBy Edits made in this way may wait.
   */
  tell(butBy?: By): void {
    const { untold } = this;
    if (!untold || untold.by === butBy || !this.greeted) return;
    const table = this.table();
    if (!table || !this.before) return;
    const now = filled(table, this.before);
    const gait = this.gait(now);
    if (!gait) return;
    const before = toWire(filled(this.before, now)) ?? gait.table;
    const isSame = JSON.stringify(before) === JSON.stringify(gait.table);
    if (isSame && !toWire(table)) return; // the next angle belongs to this edit
    clearTimeout(untold.timer);
    this.untold = null;
    this.before = now;
    if (!isSame) {
      const guess = untold.by === "hand" ? this.footGuess.peek() : null;
      if (guess) this.footGuess.value = null;
      this.asked.push({ ...gait, before, by: untold.by, size: untold.size, guess });
      this.ask();
    }
    this.settle();
  }

  /** Tell the gateway of all edits; ends when it has them, or is away. */
  async told(): Promise<void> {
    this.tell();
    await this.asking;
  }

  private ask(): void {
    if (!this.asking && this.asked.length) this.asking = this.askAll();
  }

  /** Ask one after another: the gateway refuses a request while too many others are open. */
  private async askAll(): Promise<void> {
    for (let edit = this.asked[0]; edit; edit = this.asked[0]) {
      try {
        const reply = await this.gateway.ask<{ guess: Judged | null }>("edit", edit);
        if (edit.guess) this.judged.value = reply.guess;
      } catch (error) {
        // Without an answer it is told again by the next connection.
        if (error instanceof Unanswered || !this.gateway.state.peek().open) break;
        if (error instanceof Refused && error.why.code === "gateway.too-much") {
          await new Promise((resolve) => setTimeout(resolve, ASK_AGAIN_MS));
          continue;
        }
      }
      this.asked.shift();
      this.settle();
    }
    this.asking = null;
  }

  private settle(): void {
    this.isTold.value = !this.untold && !this.asked.length;
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
