/** What the page's own robot would gain next, as its court says. */

import { computed, type ReadonlySignal } from "@preact/signals";
import type { Court } from "./court";
import { type Gains, Phase } from "./wire";

/** The gains of a seat; changes only when they do. Null while its robot can't win anything. */
export function gainsOf(court: Court, index: ReadonlySignal<number>): ReadonlySignal<Gains | null> {
  let last: Gains | null = null;
  let text = "null";
  const isOn = computed(() => {
    const phase = court.frame.value?.phase;
    return phase === Phase.COUNTDOWN || phase === Phase.PLAYING;
  });
  return computed(() => {
    const found = (isOn.value && court.health.value?.gains[index.value]) || null;
    const now = JSON.stringify(found);
    if (now !== text) {
      last = found;
      text = now;
    }
    return last;
  });
}
