/** The games that come next, and those of a match: their points by team, whoever sits left. Pure. */

import {
  type ContestMatch,
  type ContestSheet,
  isKnockout,
  type Later,
  type Named,
  named,
  running,
  type StageView,
  type Table,
} from "./sheet";

/** A game that is on a court, or one of the next whose teams are known. */
export interface NextGame extends Named {
  pairing: string;
  game: number;
  /** The court that it was given to, or will probably be; "" if nobody knows. */
  court: string;
  /** The id of the call that gave it to the court; "": it has none yet. */
  call: string;
  /** About when it begins, in milliseconds since 1970; 0: nobody knows, or it has been called. */
  at_ms: number;
}

/** The first games that are on courts or come next, at most so many. */
export function nextGames(sheet: ContestSheet, most: number): NextGame[] {
  const games = [
    ...running(sheet).map(({ id, ...one }) => ({ ...one, call: id, at_ms: 0 })),
    ...sheet.coming.map((one) => ({ ...one, call: "" })),
    // A final waits for the match for third place, but who plays it is known.
    ...sheet.later.flatMap((one) => {
      const teams = teamsOfLater(one);
      return teams ? [{ ...one, game: 1, teams, call: "" }] : [];
    }),
  ];
  return games.slice(0, most).map(({ pairing, game, teams, court, call, at_ms }) => ({
    pairing,
    game,
    ...named(sheet, pairing, teams),
    court,
    call,
    at_ms,
  }));
}

/** The teams of a match that can't be played yet; null while they are not both known. */
export function teamsOfLater({ who }: Later): [string, string] | null {
  const [left, right] = who.map(({ code, values }) => (code === "who.team" ? values?.team : ""));
  return left && right ? [String(left), String(right)] : null;
}

/** The next game of a team after the one of a call; null if none is known. */
export function nextGameOf(sheet: ContestSheet, team: string, call: string): NextGame | null {
  const games = nextGames(sheet, Number.POSITIVE_INFINITY);
  return games.find((one) => one.teams.includes(team) && (!one.call || one.call !== call)) ?? null;
}

/**
 * The table that the next game may change, after the last one that of the last stage; null: there
 * is none, or it is of a bracket.
 */
export function tableAhead(sheet: ContestSheet): { view: StageView; table: Table } | null {
  const [next] = nextGames(sheet, 1);
  const pairing_id = next?.pairing ?? sheet.stages.at(-1)?.matches.at(-1)?.pairing.id;
  for (const view of sheet.stages) {
    const match = view.matches.find(({ pairing }) => pairing.id === pairing_id);
    if (!match) continue;
    const { tables } = view;
    const table = tables.find(({ section }) => section === match.pairing.section) ?? tables[0];
    return table && !isKnockout(view) ? { view, table } : null;
  }
  return null;
}

/** The match of which a record is a game; null: none, or its result has not come yet. */
export function matchOf(sheet: ContestSheet, matchId: string): ContestMatch | null {
  const matches = sheet.stages.flatMap(({ matches }) => matches);
  const isOf = ({ games = [] }: ContestMatch) =>
    games.some(({ record }) => record === `${matchId}.mcap`);
  return matches.find(isOf) ?? null;
}

/** The numbers of the games that have been played, and of the next one. */
export function gamesOf(match: ContestMatch): number[] {
  const numbers = (match.games ?? []).map(({ number }) => number);
  return match.next_game ? [...numbers, match.next_game] : numbers.length ? numbers : [1];
}

/** The points of a game in the order of the match's teams; null: it has not been played. */
export function pointsOf(match: ContestMatch, number: number): [number, number] | null {
  const game = match.games?.find((one) => one.number === number);
  if (!game) return null;
  const [left, right] = game.scores;
  return isSwapped(match, number) ? [right, left] : [left, right];
}

/** Points in the order of the match's teams, as a decision has them: the left seat first. */
export function bySeat(
  match: ContestMatch,
  number: number,
  [first, second]: readonly [number, number],
): [number, number] {
  return isSwapped(match, number) ? [second, first] : [first, second];
}

/** Whether the second team sat left in a game, or will sit there. */
function isSwapped(match: ContestMatch, number: number): boolean {
  const game = match.games?.find((one) => one.number === number);
  const seats = game?.teams ?? match.next_seats;
  return Boolean(seats) && seats![0] === match.teams[1];
}
