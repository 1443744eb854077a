/** What a projector shows of a contest, one after another. Pure. */

import { bracket, type Cut, feeders } from "./bracket";
import { type NextGame, nextGames } from "./games";
import {
  byId,
  type ContestSheet,
  champions,
  isDecided,
  isKnockout,
  isMatch,
  isOver,
  type StageView,
  stateOf,
  type Table,
  type Team,
} from "./sheet";

/** A table, or some of its rows. */
export interface TablePart {
  table: Table;
  rows: Table["rows"];
}

export type Slide =
  | { is: "entered"; teams: readonly Team[] }
  | { is: "now"; games: NextGame[] }
  | { is: "podium" }
  | { is: "tables"; view: StageView; parts: TablePart[] }
  | { is: "bracket"; view: StageView; cut: Cut }
  | { is: "ratings" };

/** So many rows can be read from the back of a hall, and so many of a bracket. */
const ROWS = 9;
const BRACKET_ROWS = 4;
const BRACKET_COLUMNS = 3;
/** So many games fit a slide. */
const GAMES = 4;
/** So many teams fit a slide before the draw. */
const TEAMS = 15;
/** Two tables as small as this fit below each other. */
const SMALL_ROWS = 3;

const FIRST = { waiting: enteredSlides, running: nowSlides, over: endSlides };

/** The slides of a contest: what is played, then the stages that matter now, then the ratings. */
export function slides(sheet: ContestSheet): Slide[] {
  const matter = sheet.stages.filter((view) => !isOver(view) || view === sheet.stages.at(-1));
  const found = [
    ...FIRST[stateOf(sheet)](sheet),
    ...matter.flatMap((view) => (isKnockout(view) ? bracketSlides(view) : tableSlides(view))),
  ];
  return sheet.ratings.length ? [...found, { is: "ratings" }] : found;
}

/** Who is in before the draw; also while nobody is. */
function enteredSlides({ teams }: ContestSheet): Slide[] {
  const here = teams.filter(({ withdrawn, disqualified }) => !withdrawn && !disqualified);
  return Array.from({ length: Math.max(1, Math.ceil(here.length / TEAMS)) }, (_, index) => ({
    is: "entered",
    teams: here.slice(index * TEAMS, (index + 1) * TEAMS),
  }));
}

/** The games on courts and the next ones; more than a slide's only while courts have them. */
function nowSlides(sheet: ContestSheet): Slide[] {
  const count = Math.max(GAMES, sheet.running.length);
  const games = nextGames(sheet, Math.ceil(count / GAMES) * GAMES);
  return Array.from({ length: Math.max(1, Math.ceil(games.length / GAMES)) }, (_, index) => ({
    is: "now",
    games: games.slice(index * GAMES, (index + 1) * GAMES),
  }));
}

/** A contest that ends in several groups has no champion. */
function endSlides(sheet: ContestSheet): Slide[] {
  return champions(sheet).length ? [{ is: "podium" }] : [];
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
  const cut = shortened(view, {});
  const last: Slide = { is: "bracket", view, cut };
  if (cut.from === 0) return [last];
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
  const { rows, columns, boxes } = bracket(view, { root });
  if (boxes.length < 2) return [];
  if (rows <= BRACKET_ROWS && columns <= BRACKET_COLUMNS) return [{ root }];
  const match = boxes.find((box) => box.match.pairing.id === root)!.match;
  const before = feeders(match, byId(view)).flatMap(({ id }) => split(view, id));
  return rows <= BRACKET_ROWS ? [...before, shortened(view, { root })] : before;
}

/** Leave out so many first rounds that the rest can be read. */
function shortened(view: StageView, cut: Cut): Cut {
  for (let from = 0; ; from++) {
    const { rows, columns } = bracket(view, { ...cut, from });
    if (from === 8 || (rows <= BRACKET_ROWS && columns <= BRACKET_COLUMNS)) return { ...cut, from };
  }
}
