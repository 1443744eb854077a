/** A button of a decision: one that is not open stays within reach, and says why not. */

import { signal } from "@preact/signals";
import type { ComponentChildren } from "preact";
import { useId } from "preact/hooks";

interface Props {
  /** Why it can't be done now; "" if it can. */
  why: string;
  onAct: () => void;
  tone?: string;
  label?: string;
  children: ComponentChildren;
}

interface Bubble {
  text: string;
  leftPx: number;
  topPx: number;
  below: boolean;
}

const bubble = signal<Bubble | null>(null);
const WIDTH_PX = 300;
const ROOM_PX = 96;

export function Act({ why, onAct, tone = "", label, children }: Props) {
  const id = useId();
  const show = (button: HTMLElement) => {
    bubble.value = why ? placed(button, why) : null;
  };
  return (
    <>
      <button
        class={`button act ${tone}`}
        type="button"
        // Not `disabled`: the reason must be in reach of the keyboard and of a finger.
        aria-disabled={why ? "true" : undefined}
        aria-describedby={why ? id : undefined}
        aria-label={label}
        onClick={(event) => {
          if (why) show(event.currentTarget);
          else onAct();
        }}
        onPointerEnter={(event) => show(event.currentTarget)}
        onPointerLeave={() => {
          bubble.value = null;
        }}
        onFocus={(event) => show(event.currentTarget)}
        onBlur={() => {
          bubble.value = null;
        }}
      >
        {children}
      </button>
      {why && (
        <span id={id} class="hidden-text">
          {why}
        </span>
      )}
    </>
  );
}

/** Where the reasons appear; once on the page. */
export function Reasons() {
  const shown = bubble.value;
  if (!shown) return null;
  const { text, leftPx, topPx, below } = shown;
  return (
    <div
      class={`reason-bubble${below ? " below" : ""}`}
      aria-hidden="true"
      style={`left: ${leftPx}px; top: ${topPx}px`}
    >
      {text}
    </div>
  );
}

function placed(button: HTMLElement, text: string): Bubble {
  const box = button.getBoundingClientRect();
  const most = Math.max(8, innerWidth - WIDTH_PX - 8);
  const below = box.top < ROOM_PX;
  return {
    text,
    leftPx: Math.min(most, Math.max(8, box.left)),
    topPx: below ? box.bottom + 6 : box.top - 6,
    below,
  };
}
