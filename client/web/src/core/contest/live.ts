/** How the games stand that are on the courts now: asked of the gateway while somebody looks. */

import { signal } from "@preact/signals";
import { answerOf } from "../answer";
import type { CourtScore } from "../desk.gen";

const ADDRESS = "courts.json";
const AGAIN_MS = 1000;

export class LiveScores {
  private readonly scores = signal<readonly CourtScore[]>([]);
  private users = 0;
  private timer = 0;

  /** Begin, for one part of the page; the function that is returned ends it. */
  start(): () => void {
    if (!this.users++) void this.look();
    return () => {
      if (!--this.users) clearTimeout(this.timer);
    };
  }

  /** How the game of a call stands; null: no court has it yet, or none is heard. */
  of(call: string): CourtScore | null {
    return this.scores.value.find((one) => one.call === call) ?? null;
  }

  private async look(): Promise<void> {
    if (!document.hidden) {
      try {
        const response = await answerOf(ADDRESS, { cache: "no-cache" });
        this.scores.value = response.ok ? ((await response.json()) as CourtScore[]) : [];
      } catch {
        this.scores.value = []; // the page says already that nobody answers
      }
    }
    clearTimeout(this.timer);
    if (this.users) this.timer = window.setTimeout(() => void this.look(), AGAIN_MS);
  }
}
