/** Where the matches of a bracket stand: columns are rounds, rows are counted in boxes. Pure. */

import { byId, type ContestMatch, isMatch, origin, type StageView } from "./sheet";

export interface Box {
  match: ContestMatch;
  column: number;
  /** Row of its middle. */
  row: number;
}

/** The winner of a match goes on to a place of another one. */
export interface Line {
  from: Box;
  to: Box;
  place: 0 | 1;
}

/** Names a round above its boxes. */
export interface Heading {
  section: string;
  round: number;
  /** Number of its matches. */
  matches: number;
  column: number;
  /** Row of the upper edge of the highest box below it. */
  row: number;
}

export interface Bracket {
  boxes: Box[];
  lines: Line[];
  headings: Heading[];
  columns: number;
  rows: number;
}

/** Some matches of a bracket. */
export interface Cut {
  /** Leave out rounds before this one; rounds are counted from 0 in each part. */
  from?: number;
  /** A pairing: show only the matches that lead to it. */
  root?: string;
}

/** Rows between two parts of a bracket, for the headings of the lower one. */
const GAP_ROWS = 0.75;
/** The match for third place stands this far below the final. */
const THIRD_ROWS = 1.6;
const FINALS = "f";
const THIRD = "p";

/**
 * Lay out a bracket.
 *
 * Each part (winners' and losers' bracket) is a tree: a match stands in the middle of those whose
 * winners meet in it, and a team that comes from no match takes no row. The finals stand to the
 * right of all parts.
 *
 * @param cut What to show of it; by default all.
 */
export function bracket(view: StageView, { from = 0, root }: Cut = {}): Bracket {
  const matches = byId(view);
  const under = root === undefined ? null : tree(root, matches);
  const shown = view.matches.filter(
    (match) => isMatch(match) && (under === null || under.has(match.pairing.id)),
  );
  const parts = [...new Set(shown.map(({ pairing }) => pairing.section))];
  const boxes = new Map<string, Box>();
  const headings: Heading[] = [];
  let rows = 0;

  for (const section of parts.filter((part) => part !== FINALS && part !== THIRD)) {
    const part = shown.filter(({ pairing }) => pairing.section === section);
    const top = boxes.size ? rows + GAP_ROWS : 0;
    const all = [...new Set(part.map(({ pairing }) => pairing.round))];
    const kept = all.slice(Math.min(from, all.length - 1));
    rows = placed(part, kept, matches, boxes, top);
    headings.push(...headed(part, kept, section, top));
  }

  const finals = shown.filter(({ pairing }) => pairing.section === FINALS);
  let columns = 1 + Math.max(-1, ...[...boxes.values()].map(({ column }) => column));
  for (const match of finals) {
    const before = feeders(match, matches).flatMap(({ id }) => boxes.get(id) ?? []);
    const middle = before.reduce((sum, { row }) => sum + row, 0) / before.length;
    const row = before.length ? middle : rows + 0.5;
    const { section, round } = match.pairing;
    boxes.set(match.pairing.id, { match, column: columns, row });
    headings.push({ section, round, matches: 1, column: columns++, row: row - 0.5 });
    rows = Math.max(rows, row + 0.5);
  }

  for (const match of shown.filter(({ pairing }) => pairing.section === THIRD)) {
    const last = [...boxes.values()].filter(({ column }) => column === columns - 1);
    const row = Math.max(...last.map((box) => box.row)) + THIRD_ROWS;
    boxes.set(match.pairing.id, { match, column: columns - 1, row });
    headings.push({ section: THIRD, round: 1, matches: 1, column: columns - 1, row: row - 0.5 });
    rows = Math.max(rows, row + 0.5);
  }

  const lines = [...boxes.values()].flatMap((to) =>
    feeders(to.match, matches).flatMap(({ id, place }) => {
      const from = boxes.get(id);
      return from ? [{ from, to, place }] : [];
    }),
  );
  return { boxes: [...boxes.values()], lines, headings, columns, rows };
}

/** Place the matches of a part, and return the row below them. */
function placed(
  part: readonly ContestMatch[],
  kept: readonly number[],
  matches: ReadonlyMap<string, ContestMatch>,
  boxes: Map<string, Box>,
  top: number,
): number {
  const here = new Map(
    part
      .filter(({ pairing }) => kept.includes(pairing.round))
      .map((match) => [match.pairing.id, match]),
  );
  let next = top + 0.5;
  const place = (match: ContestMatch): number => {
    const before = feeders(match, matches).flatMap(({ id }) => here.get(id) ?? []);
    const at = before.map(place);
    const row = at.length ? (at[0]! + at.at(-1)!) / 2 : next++;
    const column = kept.indexOf(match.pairing.round);
    boxes.set(match.pairing.id, { match, column, row });
    return row;
  };
  const goesOn = new Set(
    [...here.values()].flatMap((match) => feeders(match, matches).map(({ id }) => id)),
  );
  for (const [id, match] of here) if (!goesOn.has(id)) place(match);
  return next - 0.5;
}

function headed(
  part: readonly ContestMatch[],
  kept: readonly number[],
  section: string,
  row: number,
): Heading[] {
  return kept.map((round, column) => ({
    section,
    round,
    matches: part.filter(({ pairing }) => pairing.round === round).length,
    column,
    row,
  }));
}

/** A match and all that lead to it, by pairing. */
function tree(root: string, matches: ReadonlyMap<string, ContestMatch>): Set<string> {
  const match = matches.get(root);
  const before = match ? feeders(match, matches).map(({ id }) => tree(id, matches)) : [];
  return new Set([root, ...before.flatMap((ids) => [...ids])]);
}

/** The matches whose winners meet in a match, with their places there. */
export function feeders(
  match: ContestMatch,
  matches: ReadonlyMap<string, ContestMatch>,
): { id: string; place: 0 | 1 }[] {
  const found: { id: string; place: 0 | 1 }[] = [];
  for (const place of [0, 1] as const) {
    const source = origin(match.pairing.sources[place], matches);
    if (source.source === "winner") found.push({ id: source.pairing, place });
  }
  return found;
}
