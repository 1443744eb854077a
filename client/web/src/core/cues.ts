/** What a match sounds like: cues from its frames and events. Pure. */

import { BEATS_PER_S, type Event, type Frame, Phase, type Sheet } from "./wire";

/** What is heard: before and at the start, for points, a new leader, the last seconds, a halt. */
export type CueName = "count" | "start" | "score" | "lead" | "last" | "halt" | "end";

export interface Cue {
  name: CueName;
  /** Index of the seat that it is about; less than 0: none. */
  seat: number;
}

/** What of a match was heard so far. */
export interface Heard {
  match: number;
  beat: number;
  phase: number;
  /** Seconds that a count shows; 0: there is none. */
  second: number;
  /** Index of the leading seat, through a tie the one before it; less than 0: none yet. */
  leader: number;
  /** Number of the newest event. */
  event: number;
}

/** A longer time between two frames is a leap, as in a replay or after a break: nothing is heard. */
const LEAP_BEATS = BEATS_PER_S;
const LAST_TICKS = 10 * BEATS_PER_S;
const OVER = new Set<number>([Phase.FINISHED, Phase.OFFICIAL, Phase.VOID]);
const STARTS = new Set<number>([Phase.COUNTDOWN, Phase.HALTED, Phase.READY]);

/**
 * What of a match has been heard at a frame.
 *
 * @param before What was heard at the frame before; null: nothing yet.
 */
export function heardAt(
  frame: Frame,
  sheet: Sheet,
  events: readonly Event[],
  before: Heard | null,
): Heard {
  const leader = leaderOf(frame);
  return {
    match: frame.match,
    beat: frame.beat,
    phase: frame.phase,
    second: secondOf(frame, sheet),
    leader: leader < 0 && before?.match === frame.match ? before.leader : leader,
    event: events.findLast(({ beat }) => beat <= frame.beat)?.number ?? 0,
  };
}

/**
 * The cues between two frames.
 *
 * @param before What was heard at the frame before; null: nothing yet.
 * @param now What is heard at this frame.
 * @param events Of the match.
 */
export function cuesBetween(before: Heard | null, now: Heard, events: readonly Event[]): Cue[] {
  const passed = before ? now.beat - before.beat : 0;
  if (!before || before.match !== now.match || passed < 0 || passed > LEAP_BEATS) return [];
  const cues: Cue[] = events
    .filter(({ number, beat }) => number > before.event && beat <= now.beat)
    .filter(({ seat, data }) => seat >= 0 && Number(data.points ?? 0) > 0)
    .map(({ seat }) => ({ name: "score", seat }));
  const isNewLeader = now.leader >= 0 && before.leader >= 0 && now.leader !== before.leader;
  if (isNewLeader && now.phase === Phase.PLAYING) cues.push({ name: "lead", seat: now.leader });
  if (now.second && now.second !== before.second) {
    cues.push({ name: now.phase === Phase.COUNTDOWN ? "count" : "last", seat: -1 });
  }
  if (now.phase !== before.phase) {
    if (now.phase === Phase.PLAYING && STARTS.has(before.phase)) {
      cues.push({ name: "start", seat: -1 });
    } else if (now.phase === Phase.HALTED) cues.push({ name: "halt", seat: -1 });
    else if (OVER.has(now.phase) && !OVER.has(before.phase)) {
      cues.push({ name: "end", seat: now.leader });
    }
  }
  return cues;
}

/** The seconds that a count shows: before the start, and the last ten of play; 0: none. */
function secondOf(frame: Frame, sheet: Sheet): number {
  if (frame.phase === Phase.COUNTDOWN) return Math.ceil(frame.countdown_beats / BEATS_PER_S);
  if (frame.phase !== Phase.PLAYING || !sheet.duration_s) return 0;
  const left = Math.round(sheet.duration_s * BEATS_PER_S) - frame.clock_ticks;
  return left <= LAST_TICKS ? Math.max(0, Math.ceil(left / BEATS_PER_S)) : 0;
}

/** The seat with the most points; less than 0: several have as many. */
export function leaderOf({ seats }: Pick<Frame, "seats">): number {
  const scores = seats.map(({ score }) => score);
  const most = Math.max(...scores);
  return scores.filter((score) => score === most).length === 1 ? scores.indexOf(most) : -1;
}
