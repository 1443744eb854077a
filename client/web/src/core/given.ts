/**
 * Files in the fragment of an address, which no server receives: /design hands them on to /enter of
 * another site, or to a friend's /design.
 *
 * What comes in is a stranger's: whoever reads the files reads them as any others.
 */

import { decode, encode } from "@msgpack/msgpack";
import { fromBase64, toBase64 } from "./base64";
import { SLOTS, type Slot } from "./files";
import { MAX_KEYS, MAX_POSTURES_PER_KEY, type SentFile } from "./wire";

export type GivenFiles = Record<Slot, SentFile | null>;

export interface Given {
  files: GivenFiles;
  /** The digits of each key, from 0 on, for postures that come alone; null: the sample's. */
  sequences: number[][] | null;
  /** The key that is to be tried; null: none. */
  key: number | null;
}

/** The name of the fragment's part. */
export const GIVEN = "files";
const FOUND = new RegExp(`#(?:.*&)?${GIVEN}=([A-Za-z0-9_-]+)`);
/** Longest packed text, and most bytes of what is in it. */
const MOST_TEXT = 400_000;
const MOST_BYTES = 1_000_000;
/** The end of a path: a page of the site, which somebody has copied with the address. */
const PAGE = /\/(enter|contest|play|watch|office|referee|replay)?\/*$/;

/** The address of /enter beside the typed page, or below a typed path; "": it is no address. */
export function enterPage(address: string): string {
  const typed = address.trim();
  if (!typed) return "";
  try {
    const { origin, pathname } = new URL(/^https?:\/\//i.test(typed) ? typed : `http://${typed}`);
    return `${origin}${pathname.replace(PAGE, "")}/enter`;
  } catch {
    return "";
  }
}

/** A fragment, with its "#". */
export async function fragmentOf(given: Given): Promise<string> {
  const whole = new Blob([encode(given).slice()]).stream();
  const packed = new Response(whole.pipeThrough(new CompressionStream("deflate-raw")));
  const text = toBase64(new Uint8Array(await packed.arrayBuffer()))
    .replaceAll("+", "-")
    .replaceAll("/", "_")
    .replaceAll("=", "");
  return `#${GIVEN}=${text}`;
}

/** Whether a text has an address with files. */
export const hasGiven = (text: string) => FOUND.test(text);

/** What is given in a fragment, or in an address somewhere in a text; null: nothing, or damaged. */
export async function givenIn(text: string): Promise<Given | null> {
  const packed = FOUND.exec(text)?.[1];
  if (!packed || packed.length > MOST_TEXT) return null;
  try {
    const bytes = fromBase64(packed.replaceAll("-", "+").replaceAll("_", "/"));
    const whole = new Blob([bytes]).stream().pipeThrough(new DecompressionStream("deflate-raw"));
    return checked(decode(await new Response(whole.pipeThrough(limited())).arrayBuffer()));
  } catch {
    return null;
  }
}

/** Lets so many bytes through, and fails at more: a short text can unpack to gigabytes. */
function limited(): TransformStream<Uint8Array, Uint8Array> {
  let bytes = 0;
  return new TransformStream({
    transform(part, out) {
      bytes += part.length;
      if (bytes > MOST_BYTES) throw new RangeError("too long");
      out.enqueue(part);
    },
  });
}

/** What was found, if it has the form of what is given. */
function checked(found: unknown): Given | null {
  const { files, sequences, key } = (found ?? {}) as Record<string, unknown>;
  const slots = (files ?? {}) as Record<string, unknown>;
  const isWhole =
    SLOTS.every((slot) => isFile(slots[slot])) &&
    (sequences === null || areSequences(sequences)) &&
    (key === null || isDigit(key));
  return isWhole ? ({ files, sequences, key } as Given) : null;
}

function isFile(one: unknown): boolean {
  if (one === null) return true;
  const { name, data } = (one ?? {}) as Record<string, unknown>;
  return typeof name === "string" && data instanceof Uint8Array;
}

function isDigit(one: unknown): boolean {
  return Number.isInteger(one) && (one as number) >= 0 && (one as number) < MAX_KEYS;
}

function areSequences(found: unknown): boolean {
  const isOne = (digits: unknown) =>
    Array.isArray(digits) && digits.length <= MAX_POSTURES_PER_KEY && digits.every(isDigit);
  return Array.isArray(found) && found.length <= MAX_KEYS && found.every(isOne);
}
