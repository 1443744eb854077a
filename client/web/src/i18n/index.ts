/** Messages in the reader's language; each message has its texts in all languages side by side. */

import { computed } from "@preact/signals";
import { setting } from "../core/address";
import type { Phrase } from "../core/phrase";
import { remembered } from "../core/settings";
import { classroom } from "./class";
import { common } from "./common";
import { contest } from "./contest";
import { design } from "./design";
import { office } from "./office";
import { play } from "./play";
import { referee } from "./referee";
import { render } from "./render";
import { replay } from "./replay";
import { watch } from "./watch";

export const LANGUAGES = { en: "English", ja: "日本語" } as const;
export type Language = keyof typeof LANGUAGES;

/** All messages by name: in the order of `LANGUAGES`. */
export const catalogue = {
  ...common,
  ...play,
  ...referee,
  ...watch,
  ...replay,
  ...design,
  ...classroom,
  ...contest,
  ...office,
};
export type MessageName = keyof typeof catalogue;

/** The language that the reader chose; "": as the browser has it. */
export const chosen = remembered<Language | "">("language", "");

export const language = computed<Language>(() => {
  for (const wanted of [setting("lang"), chosen.value, ...navigator.languages]) {
    const short = wanted.slice(0, 2).toLowerCase();
    if (short in LANGUAGES) return short as Language;
  }
  return "en";
});

/** A message, with values in place of its {holes}. */
export function t(name: MessageName, holes: Record<string, string | number> = {}): string {
  const text = catalogue[name][language.value === "ja" ? 1 : 0];
  return text.replace(/\{(\w+)\}/g, (hole, key: string) => String(holes[key] ?? hole));
}

/** A phrase of a court or a gateway in words; a plain text of an old record stays as it is. */
export function said(what: Phrase | string): string {
  return render(what, language.value);
}

/** The same as a whole sentence: with a capital letter and a full stop, which reasons lack. */
export function sentence(what: Phrase | string): string {
  const text = said(what);
  const begun = text.charAt(0).toUpperCase() + text.slice(1);
  if (/[.。!?…]$/.test(begun)) return begun;
  return begun + (language.value === "ja" ? "。" : ".");
}
