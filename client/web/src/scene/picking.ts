/** Finds the thing that a click points at. */

import { FOV_RAD, toView, type ViewAxes } from "./cameras";
import type { Model } from "./model";

/** A place on the field, and what is there. */
export interface Hit {
  /** Index of a marker. */
  marker?: number;
  /** Index of the seat whose robot it is. */
  seat?: number;
  /** The joint of the robot's link, where links are looked for. */
  joint?: number;
  x_m: number;
  y_m: number;
}

const ROBOT_REACH_M = 0.13;
const ROBOT_HEIGHT_M = 0.05;
/** A pole is thin: so near in the picture is near enough [parts of its height]. */
const NEAR = 0.035;

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
  const ray = rayAt(view, aspect, u, v);
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
    if (robot && Math.hypot(robot.x - x_m, robot.y - y_m) < ROBOT_REACH_M) return { ...at, seat };
  }
  const marker = markerAt(model, x_m, y_m, 0.045);
  return marker === null ? at : { ...at, marker };
}

/** The direction from the camera to a place in the picture [m, world]; of no certain length. */
export function rayAt(
  view: ViewAxes,
  aspect: number,
  u: number,
  v: number,
): [number, number, number] {
  const tan = Math.tan(FOV_RAD / 2);
  return [0, 1, 2].map(
    (axis) => view.forward[axis]! + view.right[axis]! * u * tan * aspect + view.up[axis]! * v * tan,
  ) as [number, number, number];
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
    if (!robot) continue;
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
