/**
 * Putting phrases into words, as lacoc_shared/words/render.py does: the same table, the same
 * string. tests/shared/test_words.py holds the two together.
 *
 * Nothing that arrives raises here: an unknown code shows itself with its values, a missing value
 * shows as "?", and what is nested too deep shows its code alone.
 */

import { markerKind, markerLabel } from "../core/border.ts";
import type { Phrase, Value } from "../core/phrase.ts";
import { DECIMALS, DEEPEST, LARGEST, LONGEST_LIST, LONGEST_TEXT } from "./limits.gen.ts";

/** Templates of one language, by code. */
export type Words = Readonly<Record<string, string>>;

type Hole = { name: string; formats: string[] };
type Part = string | Hole | (string | Hole)[];

const CONTROLS =
  // biome-ignore lint/suspicious/noControlCharactersInRegex: these are what is taken out
  /[\u0000-\u001f\u007f-\u009f\u061c\u200e\u200f\u2028-\u202e\u2066-\u2069\ud800-\udfff\ufeff]/gu;
const PIECE = /\{(\w+)(?::([^{}<>]*))?\}|([<>])|([^{}<>]+)/g;

const parsed = new Map<string, Part[]>();

/** A phrase in words; a plain text comes out as it is. */
export function render(phrase: Phrase | string, words: Words): string {
  return typeof phrase === "string" ? phrase : rendered(phrase, words, 0);
}

function rendered(phrase: Phrase, words: Words, depth: number): string {
  const template = found(phrase.code, words);
  if (template === undefined || depth >= DEEPEST) return unknown(phrase, words, depth);
  const values = phrase.values ?? {};
  const shown = (part: Part): string => {
    if (typeof part === "string") return part;
    if (!Array.isArray(part)) return filled(own(values, part.name), part.formats, words, depth);
    const there = part.every((one) => typeof one === "string" || !isMissing(own(values, one.name)));
    return there ? part.map(shown).join("") : "";
  };
  return parse(template).map(shown).join("");
}

function found(code: string, words: Words): string | undefined {
  return Object.hasOwn(words, code) ? words[code] : undefined;
}

function own(values: Record<string, Value>, name: string): Value {
  return Object.hasOwn(values, name) ? (values[name] ?? null) : null;
}

function isMissing(value: Value): boolean {
  return value === null || value === "" || (Array.isArray(value) && value.length === 0);
}

/** Templates of the table are held against their grammar by the test of the table. */
function parse(template: string): Part[] {
  const known = parsed.get(template);
  if (known) return known;
  const parts: Part[] = [];
  let into: Part[] = parts;
  for (const [, name, formats, bracket, text] of template.matchAll(PIECE)) {
    if (bracket === "<") {
      into = [];
      parts.push(into as (string | Hole)[]);
    } else if (bracket === ">") into = parts;
    else into.push(name ? { name, formats: formats?.split(",") ?? [] } : (text ?? ""));
  }
  parsed.set(template, parts);
  return parts;
}

function unknown(phrase: Phrase, words: Words, depth: number): string {
  const values = phrase.values ?? {};
  const plain = Object.keys(values)
    .sort()
    .slice(0, LONGEST_LIST)
    .map((name) => `${shownText(name)}: ${filled(own(values, name), [], words, DEEPEST)}`);
  const inside = depth < DEEPEST ? plain.join(", ") : "";
  return shownText(phrase.code) + (inside && ` (${inside})`);
}

function filled(value: Value, formats: string[], words: Words, depth: number): string {
  if (!Array.isArray(value)) return one(value, formats, words, depth);
  const items = value.slice(0, LONGEST_LIST).map((item) => one(item, formats, words, depth));
  const comma = word("join.comma", words);
  const joins = formats.includes("or") ? "join.or" : formats.includes("and") ? "join.and" : "";
  if (items.length < 2 || !joins) return items.join(comma);
  return items.slice(0, -1).join(comma) + word(joins, words) + items.at(-1);
}

function one(value: Value, formats: string[], words: Words, depth: number): string {
  const text = plain(value, formats, words, depth);
  if (!formats.includes("quoted")) return text;
  const [opening, closing] = word("quote.marks", words).split(" ");
  return `${opening}${text}${closing}`;
}

function plain(value: Value, formats: string[], words: Words, depth: number): string {
  if (typeof value === "boolean") return word(value ? "word.yes" : "word.no", words);
  if (typeof value === "number" || typeof value === "bigint")
    return number(Number(value), formats, words);
  if (typeof value === "string") {
    if (formats.includes("marker")) return markerText(value, words);
    for (const format of formats) {
      const code = format.slice(0, -1) + value;
      if (format.endsWith(".*") && found(code, words)) return word(code, words);
    }
    return shownText(value);
  }
  return value === null || Array.isArray(value) ? "?" : rendered(value, words, depth + 1);
}

/** A marker's name as pictures show it; names of other games stay as they are. */
export function markerText(name: string, words: Words): string {
  const label = markerLabel(name);
  const kind = markerKind(name);
  if (!label) return shownText(name);
  const values: Record<string, Value> = kind ? { number: label } : { label };
  return rendered({ code: kind ? `marker.${kind}` : "marker.disc", values }, words, 0);
}

function word(code: string, words: Words): string {
  return found(code, words) ?? code;
}

function shownText(text: string): string {
  const points = text.length > LONGEST_TEXT ? Array.from(text) : [];
  const short = points.length > LONGEST_TEXT ? `${points.slice(0, LONGEST_TEXT).join("")}…` : text;
  return short.replace(CONTROLS, "\ufffd");
}

/** Pages have a word for the minus, the sign that pictures write; programs write a hyphen. */
function number(value: number, formats: string[], words: Words): string {
  const minus = found("number.minus", words) ?? "-";
  const plural = formats.find((format) => format.startsWith("plural "));
  if (plural) {
    const [single, many] = plural.slice("plural ".length).split("|");
    return (Math.abs(value) === 1 ? single : many) ?? "";
  }
  if (!Number.isFinite(value) || Math.abs(value) >= LARGEST) return "?";
  if (formats.includes("clock")) {
    const seconds = Number(Math.abs(value).toFixed(0));
    const sign = value < 0 && seconds ? minus : "";
    return `${sign}${Math.floor(seconds / 60)}:${String(seconds % 60).padStart(2, "0")}`;
  }
  const digits = formats.find((format) => format.startsWith("."))?.slice(1);
  let text = Math.abs(value).toFixed(digits === undefined ? DECIMALS : Number(digits));
  if (digits === undefined) text = text.replace(/\.?0+$/, "");
  if (!/[1-9]/.test(text)) return text;
  return (value < 0 ? minus : formats.includes("+") ? "+" : "") + text;
}
