/** What a projector shows of a contest, one after another. Pure. */

import { bracket, type Cut, feeders } from "./bracket";
import {
  byId,
  type Called,
  type ContestSheet,
  isDecided,
  isKnockout,
  isMatch,
  isOver,
  running,
  type StageView,
  stateOf,
  type Table,
} from "./sheet";

/** A table, or some of its rows. */
export interface TablePart {
  table: Table;
  rows: Table["rows"];
}

export type Slide =
  | { is: "now"; running: Called[] }
  | { is: "winner" }
  | { is: "tables"; view: StageView; parts: TablePart[] }
  | { is: "bracket"; view: StageView; cut: Cut }
  | { is: "ratings" };

/** So many rows fit below each other, and so many of a bracket. */
const ROWS = 12;
const BRACKET_ROWS = 9;
/** So many courts fit a slide. */
const COURTS = 6;
/** Two tables as small as this fit below each other. */
const SMALL_ROWS = 4;

/** The slides of a contest: what is played, then the stages that matter now, then the ratings. */
export function slides(sheet: ContestSheet): Slide[] {
  const matter = sheet.stages.filter((view) => !isOver(view) || view === sheet.stages.at(-1));
  const first: Slide[] = stateOf(sheet) === "over" ? [{ is: "winner" }] : nowSlides(sheet);
  const found = [
    ...first,
    ...matter.flatMap((view) => (isKnockout(view) ? bracketSlides(view) : tableSlides(view))),
  ];
  return sheet.ratings.length ? [...found, { is: "ratings" }] : found;
}

function nowSlides(sheet: ContestSheet): Slide[] {
  const games = running(sheet);
  return Array.from({ length: Math.max(1, Math.ceil(games.length / COURTS)) }, (_, index) => ({
    is: "now",
    running: games.slice(index * COURTS, (index + 1) * COURTS),
  }));
}

function tableSlides(view: StageView): Slide[] {
  const parts = view.tables.flatMap((table) => {
    const pieces = Math.ceil(table.rows.length / ROWS);
    return Array.from({ length: pieces }, (_, index) => ({
      table,
      rows: table.rows.slice(index * ROWS, (index + 1) * ROWS),
    }));
  });
  const together = parts.every(({ rows }) => rows.length <= SMALL_ROWS) ? 4 : 2;
  return Array.from({ length: Math.ceil(parts.length / together) }, (_, index) => ({
    is: "tables",
    view,
    parts: parts.slice(index * together, (index + 1) * together),
  }));
}

/** A large bracket is cut: first what is not decided of its branches, then its last rounds. */
function bracketSlides(view: StageView): Slide[] {
  let from = 0;
  while (from < 8 && bracket(view, { from }).rows > BRACKET_ROWS) from++;
  const last: Slide = { is: "bracket", view, cut: { from } };
  if (from === 0) return [last];
  const matches = byId(view);
  const shown = view.matches.filter(isMatch);
  const goesOn = new Set(shown.flatMap((match) => feeders(match, matches).map(({ id }) => id)));
  const roots = shown.filter(({ pairing }) => !goesOn.has(pairing.id));
  const branches = roots.flatMap(({ pairing }) => split(view, pairing.id));
  const open = branches.filter(({ root }) =>
    bracket(view, { root: root! }).boxes.some(({ match }) => !isDecided(match)),
  );
  return [...open.map((cut): Slide => ({ is: "bracket", view, cut })), last];
}

/** Branches of a bracket that are small enough, and have more than one match. */
function split(view: StageView, root: string): Cut[] {
  const { rows, boxes } = bracket(view, { root });
  if (boxes.length < 2) return [];
  if (rows <= BRACKET_ROWS) return [{ root }];
  const match = boxes.find((box) => box.match.pairing.id === root)!.match;
  return feeders(match, byId(view)).flatMap(({ id }) => split(view, id));
}
