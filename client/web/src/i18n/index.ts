/** Everything that pages say, in the reader's language: their own messages, and phrases of programs. */

import { computed, signal } from "@preact/signals";
import { setting } from "../core/address";
import type { Phrase, Value } from "../core/phrase";
import { remembered } from "../core/settings";
import { DEEPEST } from "./limits.gen";
import { markerText, render, type Words } from "./render";
import type classroom from "./texts/en/class.json";
import type contest from "./texts/en/contest.json";
import type design from "./texts/en/design.json";
import type every from "./texts/en/every.json";
import type leg from "./texts/en/leg.json";
import type office from "./texts/en/office.json";
import type play from "./texts/en/play.json";
import type referee from "./texts/en/referee.json";
import type replay from "./texts/en/replay.json";

export const LANGUAGES = { en: "English", ja: "日本語" } as const;
export type Language = keyof typeof LANGUAGES;
type Texts = typeof every &
  typeof play &
  typeof referee &
  typeof replay &
  typeof design &
  typeof classroom &
  typeof contest &
  typeof office &
  typeof leg;
export type MessageName = keyof Texts;

/** The language that the reader chose; "": as the browser has it. */
export const chosen = remembered<Language | "">("language", "");

export const language = computed<Language>(() => {
  for (const wanted of [setting("lang"), chosen.value, ...navigator.languages]) {
    const short = wanted.slice(0, 2).toLowerCase();
    if (short in LANGUAGES) return short as Language;
  }
  return "en";
});

/** Parts of the words: "every" for all pages, the others for pages that say them often. */
export const GROUPS = [
  "every",
  "play",
  "seldom",
  "referee",
  "replay",
  "design",
  "class",
  "contest",
  "office",
  "leg",
] as const;
export type Group = (typeof GROUPS)[number];

const groups = new Set<Group>();
const words = signal<Words>({});
/** Whether all groups are in `words`, or tests gave the words. */
let hasAll = true;

/** Load parts of the words in the reader's language, and again whenever she chooses another. */
export async function loadWords(...wanted: Group[]): Promise<void> {
  for (const group of wanted) groups.add(group);
  if (groups.size < GROUPS.length) hasAll = false;
  await load(language.peek());
}

language.subscribe((into) => {
  if (groups.size) void load(into);
});

async function load(into: Language): Promise<void> {
  const files = [...groups].map((group) => import(`./texts/${into}/${group}.json`));
  const parts: { default: Words }[] = await Promise.all(files);
  if (into !== language.value) return;
  hasAll = files.length === GROUPS.length;
  setWords(Object.assign({}, ...parts.map((part) => part.default)));
}

export function setWords(all: Words): void {
  words.value = all;
}

/** Whether there is a message with this name. */
export function isMessage(name: string): name is MessageName {
  return Object.hasOwn(words.value, name);
}

/** A message, with values in place of its {holes}. */
export function t(name: MessageName, holes: Record<string, string | number> = {}): string {
  return said({ code: name, values: holes });
}

/**
 * A phrase of a court or a gateway in words; a plain text of an old record stays as it is.
 *
 * A page has the words that it usually needs. Where others are said, it loads all of them.
 */
export function said(what: Phrase | string): string {
  if (typeof what === "string") return what;
  if (!hasAll && lacksWords(what)) {
    if (groups.size < GROUPS.length) {
      loadWords(...GROUPS).catch(() => {
        hasAll = true; // without a network there are no more: codes are better than nothing
      });
    }
    return "…";
  }
  return render(what, words.value);
}

function lacksWords({ code, values = {} }: Phrase, depth = 0): boolean {
  const inside = Object.values(values).flat().filter(isPhrase);
  return !isMessage(code) || (depth < DEEPEST && inside.some((one) => lacksWords(one, depth + 1)));
}

function isPhrase(value: Value): value is Phrase {
  return typeof value === "object" && value !== null && "code" in value;
}

/** The same as a whole sentence: with a capital letter and a full stop, which reasons lack. */
export function sentence(what: Phrase | string): string {
  const text = said(what);
  const begun = text.charAt(0).toUpperCase() + text.slice(1);
  if (/[.。!?…]$/.test(begun)) return begun;
  return begun + (language.value === "ja" ? "。" : ".");
}

/** A marker in words, as pictures show it: "disc C4", "flag 16". */
export function markerName(name: string): string {
  return markerText(name, words.value);
}
