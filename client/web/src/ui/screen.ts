/** Facts about the screen that a page is on. */

import { signal } from "@preact/signals";

const upright = matchMedia("(max-width: 760px)");

/** A phone held upright: parts stand below one another. */
export const isNarrow = signal(upright.matches);
upright.addEventListener("change", () => {
  isNarrow.value = upright.matches;
});

/** Fill the screen, or come back from it; a browser may refuse. */
export function toggleFullscreen(): void {
  const change = document.fullscreenElement
    ? document.exitFullscreen()
    : document.documentElement.requestFullscreen();
  change.catch(() => undefined);
}
