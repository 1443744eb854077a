/** What a person has chosen, kept in this browser. */

import { effect, type Signal, signal } from "@preact/signals";

const PREFIX = "lacoc.";

/** A signal that is remembered; `otherwise` until something was chosen. */
export function remembered<T>(name: string, otherwise: T): Signal<T> {
  const kept = signal<T>(read(name, otherwise));
  effect(() => {
    try {
      localStorage.setItem(PREFIX + name, JSON.stringify(kept.value));
    } catch {
      // A browser that keeps nothing still plays.
    }
  });
  return kept;
}

function read<T>(name: string, otherwise: T): T {
  try {
    const text = localStorage.getItem(PREFIX + name);
    return text === null ? otherwise : (JSON.parse(text) as T);
  } catch {
    return otherwise;
  }
}

export type Quality = "auto" | "low" | "high";

export const quality = remembered<Quality>("quality", "auto");
