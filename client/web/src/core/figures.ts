/** How a match was played, in figures that people compare. Pure. */

import { goneEvents } from "./rulings";
import type { Event, HealthVerdict } from "./wire";

/** The figures of one seat. */
export interface Figures {
  /** How often it scored. */
  moves: number;
  /** The points of all these. */
  points: number;
  /** The points of the largest one. */
  largest: number;
  /** How often it was put back to its start. */
  restarts: number;
  /** How far its robot walked [m]. */
  walkedM: number;
  /** How many keys took effect. */
  keys: number;
  /** The digits that took effect most often, as level and digit ("B2"), and how often. */
  often: readonly (readonly [key: string, times: number])[];
}

const OFTEN = 3;

/**
 * The figures of each seat; what the referee took back does not count.
 *
 * @param verdict Has the walks and the keys; null, or of an older court: nobody counted them.
 */
export function figures(
  events: readonly Event[],
  seats: number,
  verdict: HealthVerdict | null = null,
): Figures[] {
  const standing = scored(events);
  return Array.from({ length: seats }, (_, seat) => {
    const points = standing.filter((event) => event.seat === seat).map(pointsOf);
    return {
      moves: points.length,
      points: points.reduce((sum, one) => sum + one, 0),
      largest: Math.max(0, ...points),
      restarts: events.filter(({ kind, seat: own }) => kind === "restart" && own === seat).length,
      ...walkOf(verdict?.seats[seat]),
    };
  });
}

function walkOf(seat: HealthVerdict["seats"][number] | undefined) {
  const digits = Object.entries(seat?.keys ?? {}).filter(([key]) => key !== "x");
  const often = digits.sort(([, one], [, other]) => other - one).slice(0, OFTEN);
  return {
    walkedM: seat?.walked_m ?? 0,
    keys: digits.reduce((sum, [, times]) => sum + times, 0),
    often,
  };
}

/**
 * The largest scoring move of the winner, the last of equal ones; null if there is none.
 *
 * @param winner Index of the winner's seat; less than 0: of anybody.
 */
export function decisive(events: readonly Event[], winner: number): Event | null {
  const own = scored(events).filter(({ seat }) => winner < 0 || seat === winner);
  const most = Math.max(0, ...own.map(pointsOf));
  return most > 0 ? (own.findLast((event) => pointsOf(event) === most) ?? null) : null;
}

function scored(events: readonly Event[]): Event[] {
  const gone = goneEvents(events);
  return events.filter(
    (event) => pointsOf(event) > 0 && event.seat >= 0 && !gone.has(event.number),
  );
}

function pointsOf({ data }: Event): number {
  return typeof data.marker === "string" ? Number(data.points ?? 0) : 0;
}
