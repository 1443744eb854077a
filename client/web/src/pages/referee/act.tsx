/** A button of a decision: one that is not open stays within reach, and says why not. */

import { signal } from "@preact/signals";
import type { ComponentChildren } from "preact";
import { useCallback, useEffect, useId } from "preact/hooks";

interface Props {
  /** Why it can't be done now; "" if it can. */
  why: string;
  onAct: () => void;
  tone?: string;
  label?: string;
  children: ComponentChildren;
}

interface Bubble {
  /** The id of the reason that it shows. */
  of: string;
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
    bubble.value = why ? { of: id, text: why, ...placed(button) } : null;
  };
  const hide = useCallback(() => {
    if (bubble.peek()?.of === id) bubble.value = null;
  }, [id]);
  useEffect(() => {
    const shown = bubble.peek();
    if (shown?.of === id) bubble.value = why ? { ...shown, text: why } : null;
  }, [id, why]);
  // A button that goes away under the pointer tells nobody that it was left.
  useEffect(() => hide, [hide]);
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
        onPointerLeave={hide}
        onFocus={(event) => {
          // By keyboard: a dialog gives the focus back also where a pointer closed it.
          if (event.currentTarget.matches(":focus-visible")) show(event.currentTarget);
        }}
        onBlur={hide}
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

function placed(button: HTMLElement): Omit<Bubble, "of" | "text"> {
  const box = button.getBoundingClientRect();
  const most = Math.max(8, innerWidth - WIDTH_PX - 8);
  const below = box.top < ROOM_PX;
  return {
    leftPx: Math.min(most, Math.max(8, box.left)),
    topPx: below ? box.bottom + 6 : box.top - 6,
    below,
  };
}
