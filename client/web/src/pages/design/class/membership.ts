/** The student's place in a class: what lets this browser in, and what the door asks for. */

import { signal } from "@preact/signals";
import { runKey } from "../../../core/address";
import { type Refused, Unanswered } from "../../../core/connection";
import { SAMPLE_SEQUENCES, sequences } from "../../../core/files";
import type { Phrase } from "../../../core/phrase";
import { place as kept } from "../../../core/place";
import type { OpenedTable, SentFile } from "../../../core/wire";

/** What the gateway says to a page that it has let in. */
export interface Greeting {
  /** The robot of the command line; null: it names none. */
  robot: SentFile | null;
  /** The nickname in a class; null: whoever designs alone. */
  student: string | null;
  token: string | null;
  /** The table that all pages of the student share. */
  table: OpenedTable;
  /** Whether phase 4 is done, so that a page without a table begins with the sample. */
  earned: boolean;
  /** Where a table can be taken; null: nowhere. */
  court: "practice" | null;
}

/** What somebody must do at the door of a class. */
export interface Door {
  /** Why what was shown did not open it; null: nothing was shown yet. */
  why: Phrase | null;
  /** The nickname of before. */
  name: string;
}

/** Answers that ask for the class code and a nickname. */
const AT_DOOR = ["class.enter", "class.unknown-token"];

export class Membership {
  /** The nickname; null: not in a class, or not let in yet. */
  readonly name = signal<string | null>(null);
  /** null: the page needs no form. */
  readonly door = signal<Door | null>(null);
  /** Whether the teacher has deleted the student: this page can do nothing any more. */
  readonly isForgotten = signal(false);
  private typed: { code: string; name: string } | null = null;

  /** What a hello shows. */
  shown(): object {
    const key = runKey() ?? "";
    if (this.typed) return { key, ...this.typed };
    const own = kept.peek();
    return own ? { key, name: own.name, token: own.token } : { key };
  }

  /** Show the class code and a nickname with the next hello. */
  type(code: string, name: string): void {
    this.typed = { code, name };
  }

  /** The gateway has let the page in. */
  entered({ student, token }: Greeting): void {
    this.typed = null;
    this.door.value = null;
    this.name.value = student;
    if (student === null || token === null) return;
    const own = kept.peek();
    kept.value = { name: student, token, answered: own?.token === token ? own.answered : 0 };
  }

  /** The gateway has not let the page in. */
  refused(error: Refused): void {
    if (error instanceof Unanswered) return; // the next connection shows the same
    const { why } = error;
    const { typed } = this;
    this.typed = null;
    if (why.code === "class.unknown-token") kept.value = { ...kept.peek()!, token: "" };
    const name = typed?.name ?? kept.peek()?.name ?? "";
    const isFirst = why.code === "class.enter" && !typed;
    if (this.door.peek() || AT_DOOR.includes(why.code)) {
      this.door.value = { why: isFirst ? (this.door.peek()?.why ?? null) : why, name };
    }
  }

  /** Forget the place: whoever uses this browser next comes in as somebody else. */
  leave(): void {
    kept.value = null;
    sequences.value = SAMPLE_SEQUENCES;
    location.reload();
  }

  /** Number of the last handed-out table that was answered. */
  get answered(): number {
    return kept.value?.answered ?? 0;
  }

  /** Remember that a handed-out table was taken or put off. */
  answer(number: number): void {
    const own = kept.peek();
    if (own) kept.value = { ...own, answered: number };
  }
}
