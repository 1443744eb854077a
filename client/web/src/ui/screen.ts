/** Facts about the screen that a page is on. */

import { type ReadonlySignal, signal } from "@preact/signals";

/** A phone held upright: parts stand below one another. */
export const isNarrow = matches("(max-width: 760px)");

/** There is room beside the field for more than the keys. */
export const isRoomy = matches("(min-width: 821px) and (min-height: 641px)");

/** Whether a media query matches, as a signal. */
function matches(query: string): ReadonlySignal<boolean> {
  const media = matchMedia(query);
  const now = signal(media.matches);
  media.addEventListener("change", () => {
    now.value = media.matches;
  });
  return now;
}

/** Fill the screen, or come back from it; a browser may refuse. */
export function toggleFullscreen(): void {
  const change = document.fullscreenElement
    ? document.exitFullscreen()
    : document.documentElement.requestFullscreen();
  change.catch(() => undefined);
}
