/** Short notes that go away by themselves. */

import { signal } from "@preact/signals";

type Tone = "plain" | "yes" | "no";

interface Toast {
  id: number;
  say: () => string;
  tone: Tone;
}

const SHOWN_MS = 5000;
const MOST = 4;

const toasts = signal<Toast[]>([]);
let lastId = 0;

/**
 * Show a text; the same text again only restarts its time.
 *
 * @param text Itself, or what makes it: words that a page seldom says come a little later.
 */
export function toast(text: string | (() => string), tone: Tone = "plain"): void {
  const id = ++lastId;
  const say = typeof text === "string" ? () => text : text;
  const others = toasts.value.filter((one) => one.say() !== say());
  toasts.value = [...others.slice(1 - MOST), { id, say, tone }];
  setTimeout(() => {
    toasts.value = toasts.value.filter((one) => one.id !== id);
  }, SHOWN_MS);
}

interface Props {
  /** Stands where the page put it and shows the newest only, not low over the page. */
  inPlace?: boolean;
}

export function Toasts({ inPlace = false }: Props) {
  return (
    <div class={inPlace ? "toasts in-place" : "toasts"} role="status" aria-live="polite">
      {toasts.value.map(({ id, say, tone }) => (
        <div key={id} class={`toast ${tone}`}>
          {say()}
        </div>
      ))}
    </div>
  );
}
