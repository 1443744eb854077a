/** The lesson as part of a class, or of somebody's own folder: what is done is kept as evidence. */

import { signal } from "@preact/signals";
import { runKey, socketUrl } from "../../core/address";
import { Connection, type Refused, Unanswered } from "../../core/connection";
import { place } from "../../core/place";
import { hasPage } from "../../core/served";
import type { Message, TookStep } from "../../core/wire";
import type { Done, Lesson } from "./lesson";

const DESIGN = "/design";

export class Attendance {
  /** Whether it is kept; null: whoever opened the lesson is in no class, and has no folder. */
  readonly keeps = signal<boolean | null>(null);
  private connection: Connection | null = null;
  /** What the gateway does not know yet. */
  private untold: Done[] = [];
  private isTelling = false;

  constructor(private readonly lesson: Lesson) {
    // From the beginning: what is answered before the gateway has greeted this page counts too.
    lesson.follower = (done) => this.add(done);
  }

  /** Come in with what lets this browser into its class or folder, if there is anything. */
  async begin(): Promise<void> {
    const mayCome = place.peek()?.token || runKey();
    if (!mayCome || !(await hasPage(DESIGN))) {
      this.leave();
      return;
    }
    this.connection = new Connection(
      socketUrl("design/ws"),
      () => this.greet(),
      (message) => this.take(message),
    );
  }

  private async greet(): Promise<void> {
    const own = place.peek();
    const shown = own ? { name: own.name, token: own.token } : {};
    try {
      const { steps } = await this.connection!.ask<{ steps: TookStep[] }>("hello", {
        key: runKey() ?? "",
        ...shown,
        lesson: true,
      });
      // After a break the page knows it all, and the student may be at work.
      if (!this.keeps.peek()) this.lesson.takeUp(steps.map(doneOf));
      this.keeps.value = true;
      this.add(this.lesson.here());
    } catch (error) {
      if (this.connection?.state.peek().open) this.leave(); // the lesson is open to anybody
      throw error;
    }
  }

  private take({ kind }: Message): void {
    if (kind === "forgotten") this.leave();
  }

  private leave(): void {
    this.connection?.end();
    this.lesson.follower = null;
    this.untold = [];
    this.keeps.value = null;
  }

  private add(done: Done): void {
    this.untold.push(done);
    void this.tell();
  }

  /** Tell all in order; what is not told now is told by the next connection. */
  private async tell(): Promise<void> {
    if (this.isTelling || !this.connection) return;
    this.isTelling = true;
    try {
      while (this.untold.length) {
        await this.connection.ask("step", this.untold[0]!).catch((error: Refused) => {
          // What is refused would be refused again; without an answer the next greeting goes on.
          if (error instanceof Unanswered || !this.connection?.state.peek().open) throw error;
        });
        this.untold.shift();
      }
    } catch {
      // The next greeting goes on.
    } finally {
      this.isTelling = false;
    }
  }
}

function doneOf({ step, robot, question, of, choice, right }: TookStep): Done {
  return { step, robot, question: question < 0 ? null : question, of, choice, right };
}
