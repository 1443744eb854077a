/**
 * Leaving a match that is on: z lies beside x, so it is held down, or meant with a pointer.
 * Meanwhile the focus stays on the field and every other key goes on steering.
 */

import { signal } from "@preact/signals";
import { t } from "../../i18n";
import { hasKeyboard } from "../../ui/screen";
import { pressing } from "./pad";

const HOLD_MS = 1000;
const SHOWN_MS = 5000;

export class Leaving {
  readonly state = signal<"" | "shown" | "held">("");
  private timer = 0;

  /** @param leave Called once leaving was meant. */
  constructor(private readonly leave: () => void) {}

  /** The key goes down. */
  hold(): void {
    this.become("held", HOLD_MS, () => this.go());
  }

  /** The key goes up, or this window lost the keyboard. */
  release(): void {
    if (this.state.peek() === "held") this.show();
  }

  /** Ask, for a while. */
  show(): void {
    this.become("shown", SHOWN_MS, () => this.end());
  }

  go(): void {
    this.end();
    this.leave();
  }

  end(): void {
    clearTimeout(this.timer);
    this.state.value = "";
  }

  private become(state: "shown" | "held", ms: number, then: () => void): void {
    clearTimeout(this.timer);
    this.state.value = state;
    this.timer = window.setTimeout(then, ms);
  }
}

/** @param onStay Called when the player stays: the keyboard goes back to the field. */
export function LeavingBar({ leaving, onStay }: { leaving: Leaving; onStay: () => void }) {
  const state = leaving.state.value;
  if (!state) return null;
  return (
    <div class={`leaving ${state}`} role="status">
      <p>{t(hasKeyboard.value ? "leaving.hold" : "leaving.ask")}</p>
      <button class="button small" type="button" {...pressing(() => leaving.go())}>
        {t("leaving.go")}
      </button>
      <button
        class="button quiet small"
        type="button"
        {...pressing(() => {
          leaving.end();
          onStay();
        })}
      >
        {t("leaving.stay")}
      </button>
    </div>
  );
}
