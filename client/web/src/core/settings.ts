/** What a person has chosen, kept in this browser. */

import { effect, type Signal, signal } from "@preact/signals";
import { browser, type Kept } from "./storage";

const PREFIX = "lacoc.";

/** A signal that is remembered; `otherwise` until something was chosen. */
export function remembered<T>(name: string, otherwise: T, where: Kept = browser): Signal<T> {
  const kept = signal<T>(read(name, otherwise, where));
  effect(() => where.write(PREFIX + name, JSON.stringify(kept.value)));
  return kept;
}

function read<T>(name: string, otherwise: T, where: Kept): T {
  try {
    const text = where.read(PREFIX + name);
    return text === null ? otherwise : (JSON.parse(text) as T);
  } catch {
    return otherwise; // nothing that this page wrote
  }
}

export type Quality = "auto" | "low" | "high";

export const quality = remembered<Quality>("quality", "auto");

/** Whether the cues of a match are heard. */
export const isLoud = remembered("sound", true);
