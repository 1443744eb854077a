/** The seats' colours, from the sheet into the page's style. */

import { effect } from "@preact/signals";
import type { Match } from "./court";

/** Keep `--seat-N` and what can be read on it as the sheet says, until the returned is called. */
export function followColours(match: Match): () => void {
  return effect(() => {
    const style = document.documentElement.style;
    for (const [index, seat] of (match.sheet.value?.seats ?? []).entries()) {
      style.setProperty(`--seat-${index}`, seat.colour);
      style.setProperty(`--ink-${index}`, isLight(seat.colour) ? "#16100a" : "#ffffff");
    }
  });
}

function isLight(colour: string): boolean {
  const [red, green, blue] = [1, 3, 5].map((at) => Number.parseInt(colour.slice(at, at + 2), 16));
  return 0.3 * red! + 0.59 * green! + 0.11 * blue! > 125;
}
