/** The organiser's timetable: the matches of each court, and what a drop asks for. Pure. */

import type { ContestSheet } from "./contest/sheet";
import type { Move, OfficeView, Slot } from "./desk.gen";

/** A court with its matches: the one that is at the court, then the others in the order of time. */
export interface Column {
  court: string;
  here: boolean;
  slots: Slot[];
}

/** The columns of the timetable, in the order of the contest file. */
export function columns(view: OfficeView): Column[] {
  return view.courts.map(({ court, here }) => ({
    court,
    here,
    slots: view.slots
      .filter((slot) => slot.court === court)
      .toSorted(
        (one, other) => Number(other.running) - Number(one.running) || one.at_ms - other.at_ms,
      ),
  }));
}

/** Who plays in the first of some games to come; "" if nobody knows both teams. */
export function teamsOfNext([next]: readonly Slot[]): string {
  return next?.teams.every(Boolean) ? next.teams.join(" – ") : "";
}

/** A game that has its result, as a paper lists it. */
export interface PlayedGame {
  pairing: string;
  game: number;
  /** Who sat left and right. */
  teams: readonly [string, string];
  scores: readonly [number, number];
  /** When its court was given it; 0: nobody knows. */
  at_ms: number;
}

/** A court with what it has played and what it will play, in the order of time. */
export interface CourtDay {
  /** "": games that no court has played. */
  court: string;
  played: PlayedGame[];
  slots: Slot[];
}

/** The whole day of each court: the games of the sheet that are over, then the timetable. */
export function wholeDay(view: OfficeView, sheet: ContestSheet): CourtDay[] {
  const played = new Map<string, PlayedGame[]>();
  for (const { matches } of sheet.stages) {
    for (const { pairing, games = [] } of matches) {
      for (const { number, teams, scores, court = "", began_ms = 0 } of games) {
        const there = played.get(court) ?? [];
        there.push({ pairing: pairing.id, game: number, teams, scores, at_ms: began_ms });
        played.set(court, there);
      }
    }
  }
  const day = columns(view).map(({ court, slots }) => ({ court, slots }));
  const gone = [...played.keys()].filter((court) => !day.some((one) => one.court === court));
  return [...day, ...gone.map((court) => ({ court, slots: [] }))].map(({ court, slots }) => ({
    court,
    played: (played.get(court) ?? []).toSorted((one, other) => one.at_ms - other.at_ms),
    slots,
  }));
}

/** Whether a decision about a match is possible: both its teams are known. */
export function canDecide({ teams }: Pick<Slot, "teams">): boolean {
  return teams.every(Boolean);
}

/** Whether a match can be moved: its game has not begun. */
export function canMove(slot: Slot): boolean {
  return !slot.begun;
}

/**
 * The request for a match that was dropped.
 *
 * @param slot The match.
 * @param court Where it was dropped.
 * @param on The match before which it was dropped; null: it was dropped on no match.
 * @returns The request; null if it changes nothing.
 */
export function dropped(slot: Slot, court: string, on: Slot | null): Omit<Move, "secret"> | null {
  if (!canMove(slot) || on?.pairing === slot.pairing) return null;
  // Nothing comes before a match that runs: what is dropped on it has its usual place at the court.
  const before = on && !on.running ? on.pairing : "";
  if (!before && court === slot.court && !slot.moved) return null;
  return {
    do: "move",
    pairing: slot.pairing,
    court,
    before,
    not_before_ms: slot.moved?.not_before_ms ?? 0,
  };
}

/** A time of day, as the field of a form has it: "14:05". */
export function clockOf(timeMs: number): string {
  if (!timeMs) return "";
  const time = new Date(timeMs);
  return [time.getHours(), time.getMinutes()].map((part) => `${part}`.padStart(2, "0")).join(":");
}

/**
 * The moment that a time of day means: today's, or tomorrow's if today's was over half a day ago.
 *
 * @param clock As `clockOf` gives it; "": none.
 * @returns The moment; 0 for none.
 */
export function momentOf(clock: string, nowMs: number): number {
  const [hours, minutes] = clock.split(":").map(Number);
  if (hours === undefined || minutes === undefined || !clock) return 0;
  const time = new Date(nowMs);
  time.setHours(hours, minutes, 0, 0);
  const HALF_DAY_MS = 43_200_000;
  if (time.getTime() < nowMs - HALF_DAY_MS) time.setDate(time.getDate() + 1);
  return time.getTime();
}
