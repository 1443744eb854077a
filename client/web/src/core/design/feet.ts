/** The feet of a posture: where they are, their ways through a gait, and how to bring them elsewhere. */

import { inverse, type Leg, points, type Three, type Unreached } from "../leg/leg";
import { jointsOfLeg } from "./parts";
import type { Cell } from "./table";

/** Points of a way between two postures. */
const STEPS = 8;
const ROUNDING_MM = 1e-6;

/** Root, 1st and 2nd of a leg [deg]; a cell without an angle has that of the start posture. */
export function anglesOf(cells: readonly Cell[], start_deg: readonly number[], leg: number): Three {
  const angles = jointsOfLeg(leg, start_deg.length / 3).map((joint) => {
    const cell = cells[joint];
    return typeof cell === "number" ? cell : start_deg[joint]!;
  });
  return angles as unknown as Three;
}

/**
 * The closed way of a foot through postures, its joints turning evenly from each to the next.
 *
 * @param postures Root, 1st and 2nd of each [deg].
 * @returns Points in the body frame [mm].
 */
export function wayOf(leg: Leg, postures: readonly Three[]): Three[] {
  const way = postures.flatMap((from, index) => {
    const to = postures[(index + 1) % postures.length]!;
    return Array.from({ length: STEPS }, (_, step) => {
      const part = step / STEPS;
      const mixed = from.map((angle, level) => angle + part * (to[level]! - angle));
      return points(leg, mixed as unknown as Three)[3];
    });
  });
  return way.length ? [...way, way[0]!] : way;
}

/** The rows before and after a row in the closed sequence of a key; null: it is not in it. */
export function neighbours(
  sequence: readonly number[] | null,
  row: number,
): { before: number; after: number } | null {
  const at = sequence?.indexOf(row) ?? -1;
  if (!sequence || at < 0 || sequence.length < 2) return null;
  const { length } = sequence;
  return { before: sequence[(at + length - 1) % length]!, after: sequence[(at + 1) % length]! };
}

/** Where a foot goes that shall come to a point. */
export interface Brought {
  /** Root, 1st and 2nd, in whole degrees; null: the leg stays as it is. */
  angles: Three | null;
  /** Why it does not come to the point itself; null: it does. */
  unreached: Unreached | null;
}

/**
 * Bring a foot to a point with the least turning from where the leg is; where the leg is too short
 * or too long for it, it points there.
 *
 * @param to In the body frame [mm].
 * @param now Root, 1st and 2nd now [deg].
 */
export function bring(leg: Leg, to: Three, now: Three): Brought {
  const found = inverse(leg, to);
  const { unreached } = found;
  const nearest = unreached ? inverse(leg, nearestTo(leg, to, unreached)) : found;
  if (nearest.unreached) return { angles: null, unreached };
  const turning = (posture: Three) =>
    posture.reduce((sum, angle, level) => sum + (angle - now[level]!) ** 2, 0);
  const least = nearest.postures.reduce((one, other) =>
    turning(other) < turning(one) ? other : one,
  );
  const [low, high] = leg.range_deg;
  const whole = least.map((angle) => {
    const round = Math.round(angle);
    // A range may end between two whole degrees.
    return (round < low ? Math.ceil(low) : round > high ? Math.floor(high) : round) + 0;
  });
  return { angles: whole as unknown as Three, unreached };
}

/** The point that is as far from the 1st hinge as the leg comes, on the line to a point. */
function nearestTo(leg: Leg, to: Three, { why }: Unreached): Three {
  const [l0, l1, l2] = leg.lengths_mm;
  const [x, y, z] = to.map((one, axis) => one - leg.position_mm[axis]!) as unknown as Three;
  const r = Math.hypot(x, y);
  const away = Math.hypot(r - l0, z);
  if (why === "range" || !r || !away) return to;
  const part = (why === "far" ? l1 + l2 - ROUNDING_MM : Math.abs(l1 - l2) + ROUNDING_MM) / away;
  const out = (l0 + part * (r - l0)) / r;
  return [x * out, y * out, z * part].map(
    (one, axis) => one + leg.position_mm[axis]!,
  ) as unknown as Three;
}
