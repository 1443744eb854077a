/** A contestant's files: recognised by their content, and kept for this tab. */

import { computed } from "@preact/signals";
import { fromBase64, toBase64 } from "./base64";
import { Refused } from "./connection";
import { remembered } from "./settings";
import { tab } from "./storage";
import { JOIN_MAX_BYTES, MAX_POSTURES_PER_KEY, type SentFile } from "./wire";

/** What a file is for; the names of the join's fields. */
export const SLOTS = ["robot", "postures", "locomotion"] as const;
export type Slot = (typeof SLOTS)[number];

/** Limit for all files together: a join is one message, which also has a name and a token. */
export const MOST_BYTES = JOIN_MAX_BYTES - 2 * 1024;

interface Kept {
  name: string;
  base64: string;
}

type KeptFiles = Partial<Record<Slot, Kept>>;

/**
 * Kept as text: a reload must join with the very same bytes, or the seat is not ready any more.
 * Kept where the wish for the seat is: another tab may be the other team's, and who sits at this
 * computer next has files of their own.
 */
const kept = remembered<KeptFiles>("files", {}, tab);

/** The sample's keys (Fig. 4-2): stand, turn left, forward, turn right. */
export const SAMPLE_SEQUENCES: readonly string[] = ["0", "8765", "1234", "5678"];

/** Level B of postures that come alone: for each key from 0 on the digits of its postures. */
export const sequences = remembered<readonly string[]>("sequences", SAMPLE_SEQUENCES, tab);

/** What joins send while files and sequences are being changed; null: what is chosen. */
const inUse = remembered<{ files: KeptFiles; sequences: readonly string[] } | null>(
  "filesInUse",
  null,
  tab,
);

/** Begin a change of files and sequences: joins send those of now until `applyChange`. */
export function beginChange(): void {
  inUse.value = { files: kept.peek(), sequences: sequences.peek() };
}

/** Let joins send what is chosen now. */
export function applyChange(): void {
  inUse.value = null;
}

/** Put back what was chosen when a change began, unless it is used or none began. */
export function cancelChange(): void {
  const before = inUse.peek();
  if (!before) return;
  kept.value = before.files;
  sequences.value = before.sequences;
  inUse.value = null;
}

cancelChange(); // the page was loaded again in the middle of a change

/** The sequences as a join sends them; null: the sample's. */
export function chosenSequences(): number[][] | null {
  const keys = inUse.peek()?.sequences ?? sequences.peek();
  const isSample = keys.join() === SAMPLE_SEQUENCES.join();
  return isSample ? null : keys.map((digits) => [...digits].map(Number));
}

/** The digits of what was typed, in whatever way they are parted and written. */
export function digitsOf(typed: string): string {
  return typed.normalize("NFKC").replace(/\D/g, "").slice(0, MAX_POSTURES_PER_KEY);
}

/** The names of the chosen files. */
export const chosenNames = computed<Record<Slot, string>>(() => ({
  robot: kept.value.robot?.name ?? "",
  postures: kept.value.postures?.name ?? "",
  locomotion: kept.value.locomotion?.name ?? "",
}));

/** The chosen files, as a join sends them. */
export function chosenFiles(): Record<Slot, SentFile | null> {
  const files = inUse.peek()?.files ?? kept.peek();
  const sent = (slot: Slot) => {
    const file = files[slot];
    return file ? { name: file.name, data: fromBase64(file.base64) } : null;
  };
  return { robot: sent("robot"), postures: sent("postures"), locomotion: sent("locomotion") };
}

/** Refuse files that are too large together: the gateway would close the connection. */
export function checkSizes(files: readonly (SentFile | null)[]): void {
  const bytes = files.reduce((sum, file) => sum + (file?.data.length ?? 0), 0);
  if (bytes <= MOST_BYTES) return;
  const values = { size_kib: Math.ceil(bytes / 1024), most_kib: MOST_BYTES / 1024 };
  throw new Refused({ code: "refused.files-too-large", values });
}

/** Keep a file in the slot that its content asks for; returns the slot. */
export async function choose(file: File): Promise<Slot> {
  const data = new Uint8Array(await file.arrayBuffer());
  const slot = slotOf(file.name, data);
  kept.value = { ...kept.value, [slot]: { name: file.name, base64: toBase64(data) } };
  return slot;
}

/** Keep files that another page has handed on, in place of those that were chosen before. */
export function keepGiven(files: Readonly<Record<Slot, SentFile | null>>): void {
  const given = SLOTS.flatMap((slot) => {
    const file = files[slot];
    return file ? [[slot, { name: file.name, base64: toBase64(file.data) }] as const] : [];
  });
  kept.value = Object.fromEntries(given);
}

/** Forget all files. */
export function forgetAll(): void {
  kept.value = {};
}

/** Forget a file. */
export function forget(slot: Slot): void {
  const { [slot]: _, ...others } = kept.value;
  kept.value = others;
}

/** What a file is for. A wrong guess does no harm: the court says what it expected. */
export function slotOf(name: string, data: Uint8Array): Slot {
  if (name.toLowerCase().endsWith(".toml")) return "robot";
  if (isWorkbook(data)) return "postures";
  const first = textOf(data)
    .split(/\r?\n/)
    .map((line) => line.trim().replaceAll('"', ""))
    .find((line) => line);
  // A robot file under another name (robot.toml.txt) begins with a remark, an entry or a table.
  if (first !== undefined && /^(#|\w+ *=|\[)/.test(first)) return "robot";
  // LocoTra-data begins with the number of its keys alone (rules 2), in any digits.
  if (first !== undefined) return /^\p{Nd}+$/u.test(first) ? "locomotion" : "postures";
  return /tra/i.test(name) ? "locomotion" : "postures";
}

function isWorkbook(data: Uint8Array): boolean {
  return data[0] === 0x50 && data[1] === 0x4b && data[2] === 3 && data[3] === 4;
}

/** Good enough to see the first line; reading in earnest is the court's. */
function textOf(data: Uint8Array): string {
  const head = data.subarray(0, 256);
  const little = (head[0] === 0xff && head[1] === 0xfe) || (head[0] !== 0 && head[1] === 0);
  const big = (head[0] === 0xfe && head[1] === 0xff) || (head[0] === 0 && head[1] !== 0);
  const encoding = little ? "utf-16le" : big ? "utf-16be" : "utf-8";
  return new TextDecoder(encoding).decode(head).replace("\uFEFF", "");
}

/** Hand a file, in its parts, to the person. */
export function download(name: string, parts: BlobPart[], type = "text/plain"): void {
  const link = document.createElement("a");
  link.href = URL.createObjectURL(new Blob(parts, { type }));
  link.download = name;
  link.click();
  setTimeout(() => URL.revokeObjectURL(link.href), 10_000);
}
