/** Whether a page shows a match of an event, or what is between two of them. */

import { computed, effect, type ReadonlySignal, signal } from "@preact/signals";
import type { Court } from "./court";
import { type Match, phaseOf } from "./match";
import { Phase } from "./wire";

type Seen = Pick<Court, "sheet" | "frame" | "begun" | "welcome" | "programme">;

/**
 * A match ends for a page when its result was read: somebody closed its card, or it stood there for
 * long enough. What is between lasts until the next match of the event is here.
 */
export class Between {
  /** Whether the result that the court shows was read. */
  readonly isRead: ReadonlySignal<boolean>;
  /** Whether what comes next stands in the place of a match. */
  readonly isOn: ReadonlySignal<boolean>;
  /** The match whose result was read. */
  private readonly read = signal("");
  /** The match whose result there is; "": none. Also where the director cuts from court to court. */
  private readonly ended: ReadonlySignal<string>;

  /** @param shown What the page shows of the court: live, or some time behind. */
  constructor(
    private readonly court: Seen,
    shown: Pick<Match, "frame">,
  ) {
    const phase = phaseOf(shown as Match);
    this.ended = computed(() => {
      const match = `${court.programme.value?.court ?? ""}/${shown.frame.value?.match}`;
      return phase.value >= Phase.FINISHED ? match : "";
    });
    this.isRead = computed(() => this.ended.value !== "" && this.read.value === this.ended.value);
    this.isOn = computed(() => {
      const sheet = court.sheet.value;
      const waits = court.frame.value?.phase === Phase.LOBBY && !!sheet?.fixture && !sheet.call;
      return court.begun.value && (waits || (this.isRead.value && !!court.welcome.value?.desk));
    });
  }

  /** The result was read. */
  begin(): void {
    this.read.value = this.ended.peek();
  }

  /** Take each final result as read after some time [ms]. */
  beginAfter(ms: number): void {
    const phase = computed(() => this.court.frame.value?.phase ?? Phase.CREATED);
    effect(() => {
      if (!this.ended.value || phase.value < Phase.OFFICIAL) return;
      const timer = setTimeout(() => this.begin(), ms);
      return () => clearTimeout(timer);
    });
  }
}
