/** What the sheet of a contest says: how it stands, rounds, results, and each team's way. Pure. */

import type {
  Called,
  Coming,
  ContestMatch,
  ContestSheet,
  Pairing,
  Rating,
  StageView,
  Standing,
  Table,
  Team,
} from "./sheet.gen";

export * from "./sheet.gen";

export type Source = Pairing["sources"][number];

/** Stands for the team of a place that stays empty, such as a bye's. */
const NOBODY = "";

/** Matches that belong together: a round, of all groups where a stage has groups. */
export interface Round {
  /** Part of a bracket, such as "w" or "l"; "" in other formats. */
  section: string;
  round: number;
  matches: ContestMatch[];
}

export function isDecided(match: ContestMatch): boolean {
  return match.state === "decided" || match.state === "off";
}

/** Whether a match has, or may get, two teams: it is no bye and will be played. */
export function isMatch(match: ContestMatch): boolean {
  return !match.teams.includes(NOBODY) && match.state !== "off";
}

/** Whether the stage is a bracket. */
export function isKnockout(view: StageView): boolean {
  return view.matches.some(({ pairing }) => typeof pairing.loser_place === "number");
}

export function isOver(view: StageView): boolean {
  return view.rounds_to_draw === 0 && view.matches.every(isDecided);
}

/** How many teams take part, and those that do not any more. */
export function teamsOf({ teams }: ContestSheet): {
  here: number;
  /** Those that have withdrawn. */
  gone: string[];
  /** Those whose place another team takes. */
  replaced: Team[];
  expelled: string[];
} {
  const expelled = teams.filter((team) => team.disqualified);
  const left = teams.filter((team) => team.withdrawn && !team.disqualified);
  return {
    here: teams.length - left.length - expelled.length,
    gone: left.filter(({ substitute }) => !substitute).map(({ name }) => name),
    replaced: left.filter(({ substitute }) => substitute),
    expelled: expelled.map(({ name }) => name),
  };
}

export function stateOf(sheet: ContestSheet): "waiting" | "running" | "over" {
  if (!sheet.stages.length) return "waiting";
  return !sheet.planned.length && sheet.stages.every(isOver) ? "over" : "running";
}

/** Whether a pause holds all games to come: then each of them is later than it was expected. */
export function isHeld({ day }: Pick<ContestSheet, "day">, nowMs: number): boolean {
  return day.paused || day.until_ms > nowMs;
}

/** The games on the courts, in the order of the courts' names: court 2 comes before court 10. */
export function running({ running }: ContestSheet): Called[] {
  return running.toSorted((a, b) => a.court.localeCompare(b.court, "en", { numeric: true }));
}

/** The teams with which a team shares its rank because all tie-breaks left them equal. */
export function equals(table: Table, { team, rank, shares }: Standing): string[] {
  if (!shares) return [];
  return table.rows.filter((row) => row.rank === rank && row.team !== team).map((row) => row.team);
}

/** Whoever has won the contest: first in the only table of its last stage. */
export function champions(sheet: ContestSheet): string[] {
  const last = sheet.stages.at(-1);
  if (!last || stateOf(sheet) !== "over" || last.tables.length !== 1) return [];
  return last.tables[0]!.rows.filter(({ rank, out }) => rank === 1 && !out).map(({ team }) => team);
}

/** The stage that is played now; the last one if none is. */
export function currentStage(sheet: ContestSheet): StageView | null {
  return sheet.stages.find((view) => !isOver(view)) ?? sheet.stages.at(-1) ?? null;
}

/** How many matches are decided, and how many there are so far. */
export function progress(sheet: ContestSheet): { done: number; all: number } {
  const matches = sheet.stages.flatMap((view) => view.matches).filter(isMatch);
  return { done: matches.filter(isDecided).length, all: matches.length };
}

/** Whether a team still has a match to play in a stage, so that its place there is not final. */
export function isStillIn(view: StageView, team: string): boolean {
  return view.matches.some((match) => !isDecided(match) && match.teams.includes(team));
}

/** The rounds of a stage in their order. Byes of a bracket are left out: their teams begin later. */
export function rounds(view: StageView): Round[] {
  const bracket = isKnockout(view);
  const found = new Map<string, Round>();
  for (const match of view.matches) {
    if (bracket ? !isMatch(match) : match.state === "off") continue;
    const { round } = match.pairing;
    const section = bracket ? match.pairing.section : "";
    const key = `${section}${round}`;
    const there = found.get(key);
    if (there) there.matches.push(match);
    else found.set(key, { section, round, matches: [match] });
  }
  return [...found.values()];
}

/** The number of a match in its round, by which it is called. */
export function numberOf(match: ContestMatch): number {
  return Number(match.pairing.id.split(".").at(-1));
}

/**
 * Where the team of an empty place will come from.
 *
 * A pairing with a bye is no match, so what comes from it comes from the pairing before.
 */
export function origin(source: Source, byId: ReadonlyMap<string, ContestMatch>): Source {
  if (source.source !== "winner") return source;
  const before = byId.get(source.pairing);
  if (!before || isMatch(before)) return source;
  const place = before.teams.findIndex((team) => team !== NOBODY);
  return place < 0 ? { source: "bye" } : origin(before.pairing.sources[place]!, byId);
}

export function byId(view: StageView): Map<string, ContestMatch> {
  return new Map(view.matches.map((match) => [match.pairing.id, match]));
}

/** The places of a match in the order in which all pages name them: left in game 1 comes first. */
export function seating(match: ContestMatch): readonly [0 | 1, 0 | 1] {
  const seats = match.games?.[0]?.teams ?? match.next_seats;
  return seats && seats[0] === match.teams[1] ? [1, 0] : [0, 1];
}

/** The teams of a game as its match names them. */
export interface Named {
  teams: [string, string];
  /** Whether the first of them sits right in this game. */
  swapped: boolean;
}

/**
 * Name the teams of a game in the order of its match, from game to game.
 *
 * @param seats Who sits left and right in this game.
 */
export function named(
  sheet: ContestSheet,
  pairing: string,
  [left, right]: readonly [string, string],
): Named {
  const match = found(sheet, pairing)?.match;
  const swapped = Boolean(match) && match!.teams[seating(match!)[0]] === right;
  return { teams: swapped ? [right, left] : [left, right], swapped };
}

/** Whether a match counts games won, not the points of its only game. */
export function countsGames(match: ContestMatch, view: StageView): boolean {
  return (view.stage.settings.games ?? 1) > 1 || (match.games?.length ?? 0) > 1;
}

/**
 * The score of a match, by place; null before the first game.
 *
 * Where games are counted, a drawn one is half a game for each.
 */
export function score(match: ContestMatch, view: StageView): [number, number] | null {
  const games = match.games ?? [];
  if (!games.length) return null;
  const points = (place: 0 | 1) => {
    const team = match.teams[place];
    const winner = (game: (typeof games)[number]) =>
      game.outcome === "left" ? game.teams[0] : game.outcome === "right" ? game.teams[1] : null;
    if (countsGames(match, view)) {
      const drawn = games.filter((game) => game.outcome === "draw").length;
      return games.filter((game) => winner(game) === team).length + drawn / 2;
    }
    return games[0]!.scores[games[0]!.teams[0] === team ? 0 : 1];
  };
  return [points(0), points(1)];
}

/** A number of a score as it is written: 1½. */
export function written(points: number): string {
  const whole = Math.floor(points);
  return points === whole ? String(points) : `${whole || ""}½`;
}

/** How a match ended, where its score does not say it: name of a message `contest.how.…`. */
export type How = "draw" | "extra" | "difference" | "seed" | "walkover" | "absent" | "void" | "bye";

export function howEnded(match: ContestMatch): How | null {
  if (match.state !== "decided" || !match.how) return null;
  if (match.how === "played") return match.winner ? null : "draw";
  if (match.how === "walkover" && !match.winner) return "absent";
  return match.how;
}

/** A match with the stage that it belongs to. */
export interface Played {
  view: StageView;
  match: ContestMatch;
}

/** What a contest says of one team. */
export interface TeamView {
  team: Team;
  /** Its places, stage by stage. */
  ranks: { view: StageView; table: Table; row: Standing }[];
  matches: Played[];
  rating: Rating | null;
  /** Its place among the ratings, from 1. */
  rated: number;
  running: Called | null;
  coming: Coming | null;
}

/** Everything about a team; null: there is none of this name. */
export function teamView(sheet: ContestSheet, name: string): TeamView | null {
  const team = sheet.teams.find((one) => one.name === name);
  if (!team) return null;
  const rated = sheet.ratings.findIndex((one) => one.team === name);
  const plays = ({ teams }: { teams: readonly (string | null)[] }) => teams.includes(name);
  return {
    team,
    ranks: sheet.stages.flatMap((view) =>
      view.tables.flatMap((table) =>
        table.rows.filter((row) => row.team === name).map((row) => ({ view, table, row })),
      ),
    ),
    matches: sheet.stages.flatMap((view) =>
      view.matches
        .filter((match) => plays(match) && match.state !== "off")
        .filter((match) => isMatch(match) || !isKnockout(view))
        .map((match) => ({ view, match })),
    ),
    rating: sheet.ratings[rated] ?? null,
    rated: rated + 1,
    running: sheet.running.find(plays) ?? null,
    coming: sheet.coming.find(plays) ?? null,
  };
}

/** The match of a pairing, with its stage. */
export function found(sheet: ContestSheet, pairing: string): Played | null {
  for (const view of sheet.stages) {
    const match = view.matches.find((one) => one.pairing.id === pairing);
    if (match) return { view, match };
  }
  return null;
}

/** Places of a bracket that a level match decided: who is before whom, and by which tie-break. */
export function levelPlaces(table: Table): { above: string; below: string; tie: string }[] {
  return table.rows.flatMap(({ team, decided_by }, at) => {
    const above = table.rows[at - 1]?.team;
    return above && decided_by ? [{ above, below: team, tie: decided_by }] : [];
  });
}

/** Tie-breaks that a table shows in columns of their own: the others are columns anyway. */
const OWN_COLUMNS = ["direct", "buchholz-cut", "buchholz", "sonneborn"];
/** Tie-breaks whose values a table shows in its other columns, or that have no value to show. */
const OTHER_COLUMNS = ["points", "wins", "fewest-lost", "difference", "seed"];

/** The columns of a table that tie-breaks have: code, and place among the table's values. */
export function tieColumns(table: Table): { code: string; index: number }[] {
  return table.tie_breaks
    .map((code, index) => ({ code, index }))
    .filter(
      ({ code }) =>
        OWN_COLUMNS.includes(code) ||
        (!OTHER_COLUMNS.includes(code) && table.rows.some((row) => row.decided_by === code)),
    );
}
