/** The games of a match: their numbers, and points by team whichever seat it has. Pure. */

import type { ContestMatch } from "./sheet.gen";

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
