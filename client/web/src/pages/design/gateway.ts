/** The gateway as this page sees it: requests, and what is said where one is refused. */

import { signal } from "@preact/signals";
import { socketUrl } from "../../core/address";
import { Connection, Refused } from "../../core/connection";
import type { Phrase } from "../../core/phrase";
import type { Message, Mistake, Request } from "../../core/wire";
import { said } from "../../i18n";
import { toast } from "../../ui/toasts";

/** Errors that stay in sight until the next try. */
export interface Trouble {
  said: Phrase;
  mistakes: readonly Mistake[];
}

export class Gateway {
  readonly trouble = signal<Trouble | null>(null);
  private readonly connection: Connection;

  /**
   * @param greet Says who the page is, each time that the connection opens.
   * @param take Takes in a message that is not a reply.
   */
  constructor(greet: () => Promise<void>, take: (message: Message) => void) {
    this.connection = new Connection(socketUrl("design/ws"), greet, take);
  }

  get state() {
    return this.connection.state;
  }

  /** Say again who the page is, such as after somebody has typed it. */
  greetAgain(): Promise<void> {
    return this.connection.greetAgain();
  }

  /** Close the connection for good. */
  end(): void {
    this.connection.end();
  }

  /** Ask the gateway; rejects with `Refused`. */
  ask<T = unknown>(what: Request, fields: object = {}): Promise<T> {
    return this.connection.ask<T>(what, fields);
  }

  /** Say why something was refused. */
  refuse(error: unknown): void {
    if (!(error instanceof Refused)) throw error;
    if (error.mistakes.length) {
      // A robot and a gait may both have mistakes: neither list hides the other.
      const before = this.trouble.peek()?.mistakes ?? [];
      this.trouble.value = { said: error.why, mistakes: [...before, ...error.mistakes] };
    } else toast(() => said(error.why), "no");
  }

  /** Say what was found out beside a reply. */
  tell(notes: readonly Phrase[] = []): void {
    for (const note of notes) toast(() => said(note));
  }
}
