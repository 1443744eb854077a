/** Clocks, scores and states in words, the same on every page. */

import type { Match } from "../core/match";
import { BEATS_PER_S, type Event, type Frame, Phase, SeatFlag, type Sheet } from "../core/wire";
import { language, markerName, said, t } from "./index";

export { BEATS_PER_S, markerName };

/** A time of the clock, rounded up to a second: "2:05". */
export function clock(ticks: number): string {
  const seconds = Math.ceil(Math.max(0, ticks) / BEATS_PER_S);
  return `${Math.floor(seconds / 60)}:${String(seconds % 60).padStart(2, "0")}`;
}

/** A time with its tenths, as logs have it: "2:04.6". */
export function logClock(ticks: number): string {
  const tenths = Math.floor((Math.max(0, ticks) * 10) / BEATS_PER_S);
  const seconds = ((tenths % 600) / 10).toFixed(1).padStart(4, "0");
  return `${Math.floor(tenths / 600)}:${seconds}`;
}

/** Ticks left at a frame or an event; in a match without a time limit, ticks played. */
export function clockTicks({ clock_ticks }: { clock_ticks: number }, sheet: Sheet): number {
  const lasts = Math.round(sheet.duration_s * BEATS_PER_S);
  return lasts ? lasts - clock_ticks : clock_ticks;
}

/** When an event was: the time that the clock showed. */
export function eventClock(event: Event, sheet: Sheet | null): string {
  return sheet ? logClock(clockTicks(event, sheet)) : "";
}

/** The name of a seat's team; the seat's name while it has no team. */
export function team(sheet: Sheet, index: number): string {
  const seat = sheet.seats[index];
  return seat ? seat.team || seatName(seat.id) : "";
}

/** Which match of a contest it is ("Semi-final 1"), as an office assigned it; "": none. */
export function fixtureOf({ call, fixture }: Sheet): string {
  return call && fixture ? said(fixture) : "";
}

/** What is played: the match of the contest, and the game. */
export function played(sheet: Sheet): string {
  return [fixtureOf(sheet), sheet.title].filter(Boolean).join(" · ");
}

/** What the game is about and how one scores; "" if its arena does not say. */
export function ruleOf(sheet: Sheet | null): string {
  return sheet?.rule ? said(sheet.rule) : "";
}

/** A seat's name in the reader's language. */
export function seatName(id: string): string {
  return id === "left" || id === "right" || id === "solo" ? t(`seat.${id}`) : id;
}

/** Why a seat's keys do nothing now, or that it is silent; "" if all is well or play is over. */
export function seatState(frame: Frame, index: number): string {
  const seat = frame.seats[index];
  if (!seat || frame.phase >= Phase.FINISHED) return "";
  const seconds = Math.ceil(seat.locked_ticks / BEATS_PER_S);
  if (seat.flags & SeatFlag.FROZEN) return t("seat.frozen", { seconds });
  if (seat.locked_ticks) return t("seat.locked", { seconds });
  return seat.flags & SeatFlag.SILENT ? t("seat.silent") : "";
}

/** The seat that is ahead and by how many points; null if level. */
export function leader(frame: Frame): { index: number; points: number } | null {
  const [left, right] = frame.seats.map((seat) => seat.score);
  if (left === undefined || right === undefined || left === right) return null;
  return { index: left > right ? 0 : 1, points: Math.abs(left - right) };
}

/** What the phase means for spectators, and what comes next. */
export function hint(match: Match): string {
  const frame = match.frame.value;
  const sheet = match.sheet.value;
  if (!frame || !sheet) return "";
  switch (frame.phase) {
    case Phase.CREATED:
      return t("hint.opens");
    case Phase.LOBBY:
      return sheet.fixture && !sheet.call ? said(sheet.fixture) : missing(frame, sheet);
    case Phase.READY:
      return t("hint.start");
    case Phase.COUNTDOWN:
      return t("hint.countdown", { seconds: Math.ceil(frame.countdown_beats / BEATS_PER_S) });
    case Phase.PLAYING: {
      if (sheet.seats.length < 2) return "";
      const ahead = leader(frame);
      if (!ahead) return t("hint.level");
      return t("hint.leads", { team: team(sheet, ahead.index), points: ahead.points });
    }
    case Phase.HALTED:
      return t("hint.halted");
    case Phase.FINISHED:
      return t("hint.finished");
    case Phase.OFFICIAL:
      return outcome(match);
    default:
      return t("hint.void");
  }
}

/** Who has won, in words: by the referee's declaration, else by the rules; "" while it is open. */
export function outcome(match: Match): string {
  const sheet = match.sheet.value;
  const winner = winnerOf(match);
  if (!sheet || winner === null) return "";
  if (winner === "draw") return t("hint.draw");
  const index = sheet.seats.findIndex((seat) => seat.id === winner);
  return t("hint.wins", { team: team(sheet, index) });
}

/** The winner's seat id or "draw", by the referee's declaration, else by the rules; null: open. */
export function winnerOf(match: Match): string | null {
  const events = match.events.value;
  const declared = events.findLast(({ data }) => data.decision === "declare")?.data.arguments;
  const word = (declared as { winner?: string } | undefined)?.winner;
  return word ?? byRules(events);
}

/** The winner by the rules alone. */
export function byRules(events: readonly Event[]): string | null {
  const result = events.findLast(({ kind }) => kind === "result");
  return result ? String(result.data.winner) : null;
}

function missing(frame: Frame, sheet: Sheet): string {
  for (const [index, seat] of frame.seats.entries()) {
    const name = team(sheet, index);
    if (!(seat.flags & SeatFlag.JOINED)) {
      const { team: assigned, id } = sheet.seats[index]!;
      return assigned
        ? t("hint.joining", { team: assigned })
        : t("hint.joiningSeat", { seat: seatName(id) });
    }
    if (!(seat.flags & SeatFlag.READY)) return t("hint.notReady", { team: name });
  }
  return t("hint.opens");
}

/** A time of day, such as 16:05. */
export function timeOf(timeMs: number): string {
  const options = { hour: "2-digit", minute: "2-digit", hourCycle: "h23" } as const;
  return new Date(timeMs).toLocaleTimeString(language.value, options);
}

const MINUTE_MS = 60_000;

/** The end of a pause as a time of day: the first full minute in which it is over. */
export function endOf(timeMs: number): string {
  return timeOf(Math.ceil(timeMs / MINUTE_MS) * MINUTE_MS);
}

/** A moment of this week, such as Sat 16:05. */
export function dayTime(timeMs: number): string {
  const options = {
    weekday: "short",
    hour: "2-digit",
    minute: "2-digit",
    hourCycle: "h23",
  } as const;
  return new Date(timeMs).toLocaleString(language.value, options);
}

/** A day with its time, such as 25 Nov 2026, 16:05. */
export function dateTime(time: number | string): string {
  const options = { dateStyle: "medium", timeStyle: "short" } as const;
  return new Date(time).toLocaleString(language.value, options);
}
