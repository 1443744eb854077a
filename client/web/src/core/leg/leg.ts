/**
 * One leg by triangles: where its foot is, and which angles bring the foot to a point.
 *
 * The same leg as `LegSpec` of robots/lacoc_robots/leg.py (rules 1), in millimetres and degrees.
 * The body frame has +x right, +y forward and +z up.
 */

import type { LegShape } from "../wire";

export type Three = readonly [number, number, number];

/** Lengths in millimetres, angles in degrees. */
export type Leg = Readonly<LegShape>;

/** A robot as its file describes it. */
export interface SampleRobot {
  name: string;
  /** Width, length and height of the body. */
  size_mm: Three;
  legs: readonly Leg[];
  /** The posture in which the robot begins, by joint id. */
  start_deg: readonly number[];
}

/** A point in the plane of a leg, seen from its root hinge: outward and up [mm]. */
export interface Spot {
  r: number;
  z: number;
}

/** Why no posture brings the foot to a point. */
export type Unreached =
  | { why: "far" | "near"; by_mm: number }
  /** A joint would have to turn beyond its range; level 0 is Root. */
  | { why: "range"; level: 0 | 1 | 2; angle_deg: number };

/** All postures that bring the foot to a point; without any, why there is none. */
export type Postures<Posture> =
  | { postures: readonly [Posture, ...Posture[]]; unreached: null }
  | { postures: readonly []; unreached: Unreached };

const DEGREES = 180 / Math.PI;
/** A distance smaller than this is a rounding error [mm], or as an angle [deg]. */
const TINY = 1e-9;

export const sin = (deg: number) => Math.sin(deg / DEGREES);
export const cos = (deg: number) => Math.cos(deg / DEGREES);

/** 1 for a leg on the right, -1 on the left: so a positive Root swings forward on both sides. */
export function sideOf({ outward_deg }: Leg): 1 | -1 {
  return cos(outward_deg) > 0 ? 1 : -1;
}

/** Where the 1st hinge, the 2nd hinge (the knee) and the foot are in the plane of the leg. */
export function spots({ lengths_mm }: Leg, first: number, second: number): [Spot, Spot, Spot] {
  const [l0, l1, l2] = lengths_mm;
  const knee = { r: l0 + l1 * cos(first), z: l1 * sin(first) };
  const foot = { r: knee.r + l2 * sin(first + second), z: knee.z - l2 * cos(first + second) };
  return [{ r: l0, z: 0 }, knee, foot];
}

/** Root hinge, 1st hinge, 2nd hinge and foot in the body frame [mm]. */
export function points(leg: Leg, [root, first, second]: Three): [Three, Three, Three, Three] {
  const heading = leg.outward_deg + sideOf(leg) * root;
  const [x, y, z] = leg.position_mm;
  const place = (spot: Spot): Three => [
    x + spot.r * cos(heading),
    y + spot.r * sin(heading),
    z + spot.z,
  ];
  const [hip, knee, foot] = spots(leg, first, second);
  return [leg.position_mm, place(hip), place(knee), place(foot)];
}

/** All angles of 1st and 2nd that bring the foot to a spot in the plane of the leg. */
export function bent(leg: Leg, spot: Spot): Postures<readonly [number, number]> {
  const [l0, l1, l2] = leg.lengths_mm;
  const out = spot.r - l0;
  const away = Math.hypot(out, spot.z);
  if (away > l1 + l2 + TINY) return none({ why: "far", by_mm: away - l1 - l2 });
  const nearest = Math.abs(l1 - l2);
  if (away < nearest - TINY) return none({ why: "near", by_mm: nearest - away });
  // The angle between the two links, by its half: exact also where the leg is nearly straight.
  const straight = Math.max(0, (l1 + l2) ** 2 - away ** 2);
  const folded = Math.max(0, away ** 2 - nearest ** 2);
  const turn = 2 * Math.atan2(Math.sqrt(straight), Math.sqrt(folded)) * DEGREES;
  // The knee up comes first.
  const turns = turn < TINY ? [0] : turn > 180 - TINY ? [180] : [-turn, turn];
  // On the 1st hinge the foot may be reached in every direction: 1st may stay at 0.
  const toSpot = away < TINY ? null : Math.atan2(spot.z, out) * DEGREES;
  const found = turns.map((one): readonly [number, number] => {
    const lean = Math.atan2(l2 * sin(one), l1 + l2 * cos(one)) * DEGREES;
    return [toSpot === null ? 0 : toSpot - lean, 90 + one];
  });
  return within(leg, found, 1) as Postures<readonly [number, number]>;
}

/** All angles that bring the foot to a point of the body frame; also with the leg turned back. */
export function inverse(leg: Leg, foot: Three): Postures<Three> {
  const [x, y, z] = foot.map((one, axis) => one - leg.position_mm[axis]!) as unknown as Three;
  const r = Math.hypot(x, y);
  // Above or below the root hinge every direction is right: Root may stay at 0.
  const heading = r < TINY ? leg.outward_deg : Math.atan2(y, x) * DEGREES;
  const root = sideOf(leg) * (heading - leg.outward_deg);
  const tries = [
    { root, bent: bent(leg, { r, z }) },
    { root: root + 180, bent: bent(leg, { r: -r, z }) },
  ];
  const found = tries.flatMap(({ root: turned, bent: { postures } }) =>
    postures.map((one): Three => [turned, ...one]),
  );
  if (!found.length) return none(tries[0]!.bent.unreached ?? tries[1]!.bent.unreached!);
  return within(leg, found, 0) as Postures<Three>;
}

/** How far a foot that stands moves the body while Root swings by an angle: 2 r sin(angle / 2). */
export function bodyWay(r_mm: number, swing_deg: number): number {
  return 2 * r_mm * sin(swing_deg / 2);
}

function none(unreached: Unreached): { postures: []; unreached: Unreached } {
  return { postures: [], unreached };
}

/** The postures whose angles are in the range; angles are the same after a whole turn. */
function within(leg: Leg, found: readonly (readonly number[])[], firstLevel: number) {
  const [low, high] = leg.range_deg;
  const isIn = (angle: number) => angle >= low - TINY && angle <= high + TINY;
  const postures: number[][] = [];
  for (const angles of found) {
    const each = angles.map((angle) => {
      const usual = wrapped(angle);
      return [usual, usual - 360, usual + 360].filter(isIn);
    });
    let made: number[][] = [[]];
    for (const ways of each) made = made.flatMap((begun) => ways.map((way) => [...begun, way]));
    postures.push(...made);
  }
  if (postures.length) return { postures, unreached: null };
  const beyond = (angle: number) => Math.max(low - angle, angle - high);
  const worst = found.map((angles) => {
    const by = angles.map((angle) => beyond(wrapped(angle)));
    const at = by.indexOf(Math.max(...by));
    return { by: by[at]!, level: (at + firstLevel) as 0 | 1 | 2, angle_deg: wrapped(angles[at]!) };
  });
  // The posture that is the least beyond says which joint is to blame.
  const { level, angle_deg } = worst.reduce((one, other) => (other.by < one.by ? other : one));
  return none({ why: "range", level, angle_deg });
}

/** The same direction, from -180 to 180 degrees. */
function wrapped(angle: number): number {
  const turned = angle % 360;
  return turned > 180 ? turned - 360 : turned < -180 ? turned + 360 : turned + 0;
}
