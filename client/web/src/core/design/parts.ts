/** Finds the part of the drawn robot that belongs to a joint of the table, and the reverse. */

import type { ForwardKinematics } from "../fk";
import type { Scene } from "../wire";
import { joint, LEVELS } from "./table";

type Three = readonly [number, number, number];

/** The index in the scene of the body that a joint turns; -1: there is none. */
export function bodyOf(scene: Scene, id: number, seat = 0): number {
  return scene.bodies.findIndex(
    (body, index) => body.joint === id && body.seat < 0 && seatOf(scene, index) === seat,
  );
}

/** The joint that turns a body; null: the body is the robot's trunk, or no robot's. */
export function jointOf(scene: Scene, body: number): number | null {
  const found = scene.bodies[body];
  return found && found.seat < 0 && found.joint >= 0 ? found.joint : null;
}

/** The joints of a leg, from the body outward. */
export function jointsOfLeg(leg: number, legs: number): number[] {
  return LEVELS.map((_, level) => joint(leg, level, legs));
}

/** The seat of the robot that a body belongs to; -1: none. */
function seatOf(scene: Scene, body: number): number {
  for (let at = body; at >= 0; at = scene.bodies[at]!.parent) {
    if (scene.bodies[at]!.seat >= 0) return scene.bodies[at]!.seat;
  }
  return -1;
}

/**
 * The joint of the link that a ray hits first; if it hits none, of the link that it passes nearest.
 *
 * @param eye Where the ray begins [m, world].
 * @param ray Its direction, of any length.
 * @param nearM Largest distance at which the ray may pass a link [m]; fingers are not exact.
 * @returns The joint id; null if no link is near.
 */
export function pickJoint(
  scene: Scene,
  fk: ForwardKinematics,
  eye: Three,
  ray: Three,
  nearM = 0.01,
): number | null {
  let found: number | null = null;
  let best = Number.POSITIVE_INFINITY;
  const length = Math.hypot(...ray);
  const way = ray.map((part) => part / length) as unknown as Three;
  for (const { body, type, size, pos, quat } of scene.geoms) {
    const id = jointOf(scene, body);
    if (id === null || fk.seats[body]! < 0) continue;
    const middle = placed(fk, body, pos);
    const along = turned(fk.quat, 4 * body, turned(quat, 0, [0, 0, 1]));
    const half = type === "capsule" || type === "cylinder" ? size[1] : 0;
    const { apart, far } = nearest(eye, way, middle, along, half);
    const beside = Math.max(0, apart - size[0]);
    // Links that are hit come before links that are only near; the first is the nearest to the eye.
    const rank = beside > 0 ? 1e3 + beside : far;
    if (beside <= nearM && far > 0 && rank < best) {
      best = rank;
      found = id;
    }
  }
  return found;
}

function placed(fk: ForwardKinematics, body: number, at: Three): Three {
  const [x, y, z] = turned(fk.quat, 4 * body, at);
  const { pos } = fk;
  return [pos[3 * body]! + x, pos[3 * body + 1]! + y, pos[3 * body + 2]! + z];
}

/** A vector turned by a quaternion. */
function turned(quat: ArrayLike<number>, at: number, [x, y, z]: Three): Three {
  const [w, i, j, k] = [quat[at]!, quat[at + 1]!, quat[at + 2]!, quat[at + 3]!];
  const [tx, ty, tz] = [2 * (j * z - k * y), 2 * (k * x - i * z), 2 * (i * y - j * x)];
  return [x + w * tx + j * tz - k * ty, y + w * ty + k * tx - i * tz, z + w * tz + i * ty - j * tx];
}

/** The distance between a ray and a segment (`apart`), and how far from the eye it is (`far`). */
function nearest(
  eye: Three,
  way: Three,
  middle: Three,
  along: Three,
  half: number,
): { apart: number; far: number } {
  const to = minus(middle, eye);
  const cosine = dot(way, along);
  const square = 1 - cosine * cosine;
  const best = square < 1e-9 ? 0 : (cosine * dot(to, way) - dot(to, along)) / square;
  const at = Math.min(half, Math.max(-half, best));
  const point = to.map((part, axis) => part + at * along[axis]!) as unknown as Three;
  const far = dot(point, way);
  return { apart: Math.sqrt(Math.max(0, dot(point, point) - far * far)), far };
}

const dot = (one: Three, other: Three) => one[0] * other[0] + one[1] * other[1] + one[2] * other[2];
const minus = (one: Three, other: Three): Three => [
  one[0] - other[0],
  one[1] - other[1],
  one[2] - other[2],
];
