/** Finds the thing that a click points at. */

import { FOV_RAD, toView, type ViewAxes } from "./cameras";
import type { Model } from "./model";

/** A place on the field, and what is there. */
export interface Hit {
  /** Index of a marker. */
  marker?: number;
  /** Index of the seat whose robot it is. */
  seat?: number;
  /** Index of the robot's body, where parts of robots are looked for. */
  body?: number;
  x_m: number;
  y_m: number;
}

const ROBOT_REACH_M = 0.13;
const ROBOT_HEIGHT_M = 0.05;
/** A pole is thin: so near in the picture is near enough [parts of its height]. */
const NEAR = 0.035;
/** So near beside a robot's part is on it. */
const PART_NEAR = 0.012;

/** Where in the picture a point is, -1 to 1 from left to right and from bottom to top. */
export function project(
  view: ViewAxes,
  aspect: number,
  x: number,
  y: number,
  z: number,
): { u: number; v: number; depth: number } {
  const [right, up, depth] = toView(view, x, y, z);
  const tan = Math.tan(FOV_RAD / 2);
  return { u: right / (depth * tan * aspect), v: up / (depth * tan), depth };
}

/** Find the thing at a place in the picture; null outside the floor. */
export function pick(
  model: Model,
  view: ViewAxes,
  aspect: number,
  u: number,
  v: number,
): Hit | null {
  const tan = Math.tan(FOV_RAD / 2);
  const ray = [0, 1, 2].map(
    (axis) => view.forward[axis]! + view.right[axis]! * u * tan * aspect + view.up[axis]! * v * tan,
  ) as [number, number, number];
  const seat = nearestRobot(model, view.eye, ray);
  if (ray[2] >= 0) return null;
  const far = -view.eye[2] / ray[2];
  const at = { x_m: view.eye[0] + ray[0] * far, y_m: view.eye[1] + ray[1] * far };
  if (seat !== null) return { ...at, seat };
  const marker = markerAt(model, at.x_m, at.y_m) ?? poleAt(model, view, aspect, u, v);
  return marker === null ? at : { ...at, marker };
}

/** Find the thing at a place on the floor, seen from straight above. */
export function pickFlat(model: Model, x_m: number, y_m: number): Hit {
  const at = { x_m, y_m };
  for (const [seat, robot] of model.robots.entries()) {
    if (Math.hypot(robot.x - x_m, robot.y - y_m) < ROBOT_REACH_M) return { ...at, seat };
  }
  const marker = markerAt(model, x_m, y_m, 0.045);
  return marker === null ? at : { ...at, marker };
}

/** Find the part of a robot at a place in the picture; null if none is near. */
export function pickPart(
  model: Model,
  view: ViewAxes,
  aspect: number,
  u: number,
  v: number,
): number | null {
  if (!model.robots.length) return null;
  const { pos, quat, seats } = model.fk;
  let found: number | null = null;
  let nearest = Number.POSITIVE_INFINITY;
  for (const { body, type, size, pos: local, quat: turn } of model.scene.geoms) {
    if (seats[body]! < 0 || type === "plane") continue;
    const half = type === "capsule" || type === "cylinder" ? size[1] : 0;
    const radius = type === "box" ? Math.min(size[0], size[1]) : size[0];
    const along = rotated(turn, [0, 0, half]);
    const [one, other] = [-1, 1].map((side) => {
      const at = local.map((part, axis) => part + side * along[axis]!) as Triple;
      const bodyTurn = [...quat.subarray(4 * body, 4 * body + 4)] as Quadruple;
      const [x, y, z] = rotated(bodyTurn, at);
      const [bx, by, bz] = pos.subarray(3 * body, 3 * body + 3);
      return project(view, aspect, x + bx!, y + by!, z + bz!);
    });
    if (one!.depth < 0.05 || other!.depth < 0.05) continue;
    const off = offSegment(u * aspect, v, one!.u * aspect, one!.v, other!.u * aspect, other!.v);
    const wide = radius / (one!.depth * Math.tan(FOV_RAD / 2)) + PART_NEAR;
    if (off > wide) continue;
    // Limbs lie over the body: of what is hit the thinnest counts, then the one that is in front.
    const rank = (type === "box" ? 10 : 0) + one!.depth + off;
    if (rank < nearest) {
      nearest = rank;
      found = body;
    }
  }
  return found;
}

type Triple = [number, number, number];
type Quadruple = [number, number, number, number];

/** Turn a vector by a quaternion w, x, y, z. */
function rotated([w, x, y, z]: Readonly<Quadruple>, [a, b, c]: Triple): Triple {
  const tx = 2 * (y * c - z * b);
  const ty = 2 * (z * a - x * c);
  const tz = 2 * (x * b - y * a);
  return [a + w * tx + y * tz - z * ty, b + w * ty + z * tx - x * tz, c + w * tz + x * ty - y * tx];
}

function offSegment(x: number, y: number, ax: number, ay: number, bx: number, by: number): number {
  const [dx, dy] = [bx - ax, by - ay];
  const squared = dx * dx + dy * dy;
  const part = squared ? ((x - ax) * dx + (y - ay) * dy) / squared : 0;
  const along = Math.min(1, Math.max(0, part));
  return Math.hypot(x - ax - along * dx, y - ay - along * dy);
}

function nearestRobot(
  model: Model,
  eye: [number, number, number],
  ray: [number, number, number],
): number | null {
  let found: number | null = null;
  let nearest = Number.POSITIVE_INFINITY;
  const length = Math.hypot(...ray);
  for (const [seat, robot] of model.robots.entries()) {
    const to = [robot.x - eye[0], robot.y - eye[1], ROBOT_HEIGHT_M - eye[2]] as const;
    const along = (to[0] * ray[0] + to[1] * ray[1] + to[2] * ray[2]) / length;
    const off = Math.sqrt(Math.max(0, to[0] ** 2 + to[1] ** 2 + to[2] ** 2 - along ** 2));
    if (off < ROBOT_REACH_M && along < nearest) {
      nearest = along;
      found = seat;
    }
  }
  return found;
}

function markerAt(model: Model, x_m: number, y_m: number, least_m = 0): number | null {
  let found: number | null = null;
  let nearest = Number.POSITIVE_INFINITY;
  for (const [index, marker] of model.sheet.markers.entries()) {
    const off = Math.hypot(marker.x_m - x_m, marker.y_m - y_m);
    if (off <= Math.max(least_m, marker.radius_m) && off < nearest) {
      nearest = off;
      found = index;
    }
  }
  return found;
}

/** A thin marker whose foot, or whose pole, is near in the picture. */
function poleAt(model: Model, view: ViewAxes, aspect: number, u: number, v: number): number | null {
  let found: number | null = null;
  let nearest = NEAR;
  for (const [index, { x_m, y_m, radius_m }] of model.sheet.markers.entries()) {
    if (radius_m > 0.04) continue;
    const standing = model.states[index] === 0;
    for (const part of standing ? [0, 0.25, 0.5, 0.75, 1] : [0]) {
      const at = project(view, aspect, x_m, y_m, part * model.field.height);
      const off = Math.hypot((at.u - u) * aspect, at.v - v);
      if (at.depth > 0 && off < nearest) {
        nearest = off;
        found = index;
      }
    }
  }
  return found;
}
