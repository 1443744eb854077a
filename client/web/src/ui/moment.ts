/** Components that change when a moment comes. */

import { useSignal } from "@preact/signals";
import { useEffect } from "preact/hooks";

/** The longest time that a browser's timer can wait. */
const LONGEST_MS = 0x7fffffff;

/** Whether a moment is still to come; the component is drawn again when it comes. */
export function useIsBefore(momentMs: number): boolean {
  const now = useSignal(0);
  const looked = now.value;
  useEffect(() => {
    const leftMs = momentMs - Date.now();
    if (leftMs <= 0) return;
    const timer = setTimeout(
      () => {
        now.value = Date.now();
      },
      Math.min(leftMs, LONGEST_MS),
    );
    return () => clearTimeout(timer);
    // A timer can end a little before its time, and then the moment is still to come.
  }, [momentMs, looked, now]);
  return momentMs > Date.now();
}
