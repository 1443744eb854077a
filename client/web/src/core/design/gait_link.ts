/**
 * A gait in an address: its files as text, packed into the fragment, which is sent to no server.
 *
 * What comes back is a stranger's: the studio reads the files as it reads any others.
 */

import { MAX_KEYS, MAX_POSTURES_PER_KEY } from "../wire";

export interface LinkedGait {
  /** Name of the gait's file. */
  name: string;
  /** What stands in it. */
  gait: string;
  /** null: the workshop's hexapod. */
  robot: { name: string; text: string } | null;
  /** The digits of each key, from 0 on; null: the file has them. */
  sequences: number[][] | null;
  /** The key that is tried. */
  key: number;
}

/** The name of the address's part. */
const PART = "gait";
const FOUND = new RegExp(`#(?:.*&)?${PART}=([A-Za-z0-9_-]+)`);
/** Longest packed text, and most bytes of what is in it. */
const MOST_TEXT = 100_000;
const MOST_BYTES = 400_000;

/** The fragment of an address that has a gait, from "#" on. */
export async function fragmentOf(gait: LinkedGait): Promise<string> {
  const text = new Blob([JSON.stringify(gait)]);
  const packed = text.stream().pipeThrough(new CompressionStream("deflate-raw"));
  const bytes = new Uint8Array(await new Response(packed).arrayBuffer());
  const letters = Array.from(bytes, (byte) => String.fromCharCode(byte)).join("");
  const base64 = btoa(letters).replaceAll("+", "-").replaceAll("/", "_").replaceAll("=", "");
  return `#${PART}=${base64}`;
}

/** Whether a text has an address with a gait. */
export const hasGait = (text: string) => FOUND.test(text);

/** The gait in an address; null: there is none, or it is damaged. */
export async function gaitIn(text: string): Promise<LinkedGait | null> {
  const packed = FOUND.exec(text)?.[1];
  if (!packed || packed.length > MOST_TEXT) return null;
  try {
    const letters = atob(packed.replaceAll("-", "+").replaceAll("_", "/"));
    const bytes = Uint8Array.from(letters, (letter) => letter.charCodeAt(0));
    const whole = new Blob([bytes]).stream().pipeThrough(new DecompressionStream("deflate-raw"));
    return checked(JSON.parse(await textOf(whole)));
  } catch {
    return null;
  }
}

/** The text of a stream; throws if it is too long. */
async function textOf(stream: ReadableStream<Uint8Array>): Promise<string> {
  const parts: Uint8Array[] = [];
  let bytes = 0;
  for (const reader = stream.getReader(); ; ) {
    const { done, value } = await reader.read();
    if (done) break;
    bytes += value.length;
    if (bytes > MOST_BYTES) {
      void reader.cancel();
      throw new RangeError("too long");
    }
    parts.push(value);
  }
  const whole = new Uint8Array(bytes);
  let at = 0;
  for (const part of parts) {
    whole.set(part, at);
    at += part.length;
  }
  return new TextDecoder("utf-8", { fatal: true }).decode(whole);
}

/** What was found, if it has the form of a gait. */
function checked(found: unknown): LinkedGait | null {
  const { name, gait, robot, sequences, key } = (found ?? {}) as Record<string, unknown>;
  const isText = typeof name === "string" && typeof gait === "string";
  if (!isText || !isDigit(key) || !isRobot(robot) || !areSequences(sequences)) return null;
  return { name, gait, robot, sequences, key };
}

function isDigit(one: unknown): one is number {
  return Number.isInteger(one) && (one as number) >= 0 && (one as number) < MAX_KEYS;
}

function isRobot(one: unknown): one is LinkedGait["robot"] {
  if (one === null) return true;
  const { name, text } = (one ?? {}) as Record<string, unknown>;
  return typeof name === "string" && typeof text === "string";
}

function areSequences(found: unknown): found is LinkedGait["sequences"] {
  if (found === null) return true;
  const isOne = (digits: unknown) =>
    Array.isArray(digits) && digits.length <= MAX_POSTURES_PER_KEY && digits.every(isDigit);
  return Array.isArray(found) && found.length <= MAX_KEYS && found.every(isOne);
}
