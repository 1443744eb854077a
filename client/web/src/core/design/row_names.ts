/**
 * Names for the rows of a table, as the shared document knows them.
 *
 * A row keeps its name while rows come and go beside it: otherwise what one page types into a row
 * would stand in its neighbour when another page inserts one at the same time.
 */

import {
  type Content,
  type Entry,
  isSameCell,
  keyIn,
  postureEntry,
  rankIn,
  rankOf,
  rowNames,
  shapeOf,
} from "./entries";
import type { Row } from "./table";

/** Longest rank after its point: the gateway takes no more [digits]. */
const DIGITS = 12;
/** A rank is drawn of so many at least: so two pages that insert at one place draw the same hardly
 * ever. They would have one row between them, and one of the two insertions would be lost. */
const DRAWN = 10_000;
/** Share of the room between two ranks, near its middle, in which a rank is drawn. */
const NEAR = 0.2;

type Entries = { get(name: string): Entry | undefined; keys(): Iterable<string> };

/**
 * The names of a content's rows: of those that the document has, as far as they are the same rows.
 *
 * @param chance Draws a number from 0 up to, but without, 1.
 */
export function namesFor(content: Content, entries: Entries, chance = Math.random): string[] {
  const shape = shapeOf(content);
  if (content.kind === "postures") return content.rows.map(({ key }) => postureEntry(shape, key));
  const known = new Map<number, string[]>();
  for (const name of rowNames(entries.keys(), shape)) {
    known.set(keyIn(name), [...(known.get(keyIn(name)) ?? []), name]);
  }
  const digits = [...known.keys()];
  const names: string[] = [];
  for (const [at, rows] of byKey(content.rows).entries()) {
    const digit = digits[at] ?? (digits.at(-1) ?? -1) + 1;
    digits[at] = digit;
    const old = known.get(digit) ?? [];
    const isSame = (name: string, row: Row) =>
      row.cells.every((cell, col) => isSameCell(entries.get(`${name}/${col}`), cell));
    const ranks = ranksFor(aligned(old, rows, isSame), chance);
    if (digit > 9 || !ranks) return byPlace(shape, content.rows);
    names.push(...ranks.map((rank) => `${shape}/${digit}.${rank}`));
  }
  return names;
}

/**
 * For each of the new things the old one that it is; null: it is new.
 *
 * What is alike at both ends stays; in the middle things go by their order.
 */
export function aligned<One, Other>(
  old: readonly One[],
  now: readonly Other[],
  isSame: (one: One, other: Other) => boolean,
): (One | null)[] {
  const most = Math.min(old.length, now.length);
  let top = 0;
  while (top < most && isSame(old[top]!, now[top]!)) top++;
  let bottom = 0;
  const same = (at: number) => isSame(old[old.length - at]!, now[now.length - at]!);
  while (bottom < most - top && same(bottom + 1)) bottom++;
  return now.map((_, at) => {
    if (at < top) return old[at]!;
    if (at >= now.length - bottom) return old[at - now.length + old.length]!;
    return at < old.length - bottom ? old[at]! : null;
  });
}

/** Ranks for the rows of a key; null: there is no room for one between two others. */
function ranksFor(names: readonly (string | null)[], chance: () => number): string[] | null {
  const ranks = names.map((name) => (name === null ? null : rankIn(name)));
  if (ranks.every((rank) => rank === null)) return ranks.map((_, at) => String(at));
  for (let at = 0; at < ranks.length; at++) {
    if (ranks[at] !== null) continue;
    const before = ranks[at - 1] ?? null;
    const after = ranks.slice(at).find((rank) => rank !== null) ?? null;
    const found = between(before, after, chance);
    if (found === null) return null;
    ranks[at] = found;
  }
  return ranks as string[];
}

/** A rank between two others; null: none that is short enough. */
function between(before: string | null, after: string | null, chance: () => number): string | null {
  const low = before === null ? -1 : rankOf(before);
  const high = after === null ? Math.floor(low) + 2 : rankOf(after);
  // One page after the other adds rows at the end: each has a whole number to begin with.
  const start = after === null ? Math.floor(low) + 1 : Math.max(0, low);
  if (start > 99) return null;
  for (let digits = 0; digits <= DIGITS; digits++) {
    const room = Math.floor((high - start) * 10 ** digits) - 1;
    if (room * NEAR < DRAWN) continue;
    // Near the middle: the next one has room on both sides.
    const steps = 1 + Math.floor(room * (0.5 + NEAR * (chance() - 0.5)));
    const rank = (start + steps / 10 ** digits).toFixed(digits).replace(".", "_");
    return rankOf(rank) > low && rankOf(rank) < high ? rank : null;
  }
  return null;
}

function byKey(rows: readonly Row[]): Row[][] {
  const keys = [...new Set(rows.map(({ key }) => key))];
  return keys.map((key) => rows.filter((row) => row.key === key));
}

function byPlace(shape: string, rows: readonly Row[]): string[] {
  return rows.map(({ key, posture }) => `${shape}/${key}.${posture}`);
}
