/** Messages in the reader's language; every message stands in all languages, side by side. */

import { computed } from "@preact/signals";
import { setting } from "../core/address";
import { remembered } from "../core/settings";
import { common } from "./common";
import { toJapanese } from "./court";
import { play } from "./play";
import { referee } from "./referee";
import { replay } from "./replay";
import { watch } from "./watch";

export const LANGUAGES = { en: "English", ja: "日本語" } as const;
export type Language = keyof typeof LANGUAGES;

/** All messages by name: in the order of `LANGUAGES`. */
export const catalogue = { ...common, ...play, ...referee, ...watch, ...replay };
export type MessageName = keyof typeof catalogue;

/** What was chosen; "" follows the browser. */
export const chosen = remembered<Language | "">("language", "");

export const language = computed<Language>(() => {
  for (const wanted of [setting("lang"), chosen.value, ...navigator.languages]) {
    const short = wanted.slice(0, 2).toLowerCase();
    if (short in LANGUAGES) return short as Language;
  }
  return "en";
});

/** A message, with what belongs into its {holes}. */
export function t(name: MessageName, holes: Record<string, string | number> = {}): string {
  const text = catalogue[name][language.value === "ja" ? 1 : 0];
  return text.replace(/\{(\w+)\}/g, (hole, key: string) => String(holes[key] ?? hole));
}

/** A sentence of the court, which speaks English. */
export function said(text: string): string {
  return language.value === "ja" ? toJapanese(text) : text;
}
