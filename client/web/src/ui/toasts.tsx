/** Short notes that go away by themselves. */

import { signal } from "@preact/signals";

type Tone = "plain" | "yes" | "no";

interface Toast {
  id: number;
  text: string;
  tone: Tone;
}

const SHOWN_MS = 5000;
const MOST = 4;

const toasts = signal<Toast[]>([]);
let lastId = 0;

/** Show a text; the same text again only restarts its time. */
export function toast(text: string, tone: Tone = "plain"): void {
  const id = ++lastId;
  const others = toasts.value.filter((one) => one.text !== text);
  toasts.value = [...others.slice(1 - MOST), { id, text, tone }];
  setTimeout(() => {
    toasts.value = toasts.value.filter((one) => one.id !== id);
  }, SHOWN_MS);
}

export function Toasts() {
  return (
    <div class="toasts" role="status" aria-live="polite">
      {toasts.value.map(({ id, text, tone }) => (
        <div key={id} class={`toast ${tone}`}>
          {text}
        </div>
      ))}
    </div>
  );
}
