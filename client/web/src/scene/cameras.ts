/** Cameras: named ones, glides between them, and turning by hand. z is up; angles in radians. */

import type { Field, Model, Robot } from "./model";

/** Where a camera is: round a point, so that going from one to another is an arc. */
export interface Shot {
  x: number;
  y: number;
  z: number;
  /** Direction from the point to the camera. */
  azimuth: number;
  elevation: number;
  distance: number;
}

/** The part of the picture that is to be filled, in -1 to 1. */
export interface Frame2d {
  left: number;
  right: number;
  top: number;
  bottom: number;
}

export const CAMERAS = [
  "auto",
  "arena",
  "top",
  "chase",
  "left",
  "right",
  "side",
  "robot", // near one robot; keeps its direction
  "map", // not a camera: the drawing from above
] as const;

export type CameraName = (typeof CAMERAS)[number];

/** Vertical opening of all cameras. */
export const FOV_RAD = (34 * Math.PI) / 180;

/** Who asks for less motion gets cameras that cut, and an automatic one that stands still. */
export const isCalm = matchMedia("(prefers-reduced-motion: reduce)");

const SOUTH = -Math.PI / 2;
const STRAIGHT_DOWN = 1.5706;
const GLIDE_MS = 900;
const LOWEST = 0.06;
const WALL_M = 0.055;
/** Beyond the floor's edge is the wall. */
const RIM_M = 0.045;

const NEAR = { distance: 0.62, elevation: 0.62, azimuth: -1.95, z: 0.035, place_ms: 90 };
const CHASE = { distance: 1.35, elevation: 0.5, ahead_m: 0.16, place_ms: 220, turn_ms: 520 };

/** The whole field, seen from a direction, as large as it fits. */
export function fitField(
  field: Field,
  azimuth: number,
  elevation: number,
  aspect: number,
  frame: Frame2d,
): Shot {
  const x = field.halfX + RIM_M;
  const y = field.halfY + RIM_M;
  const points: [number, number, number][] = [];
  for (const [a, b] of [
    [-1, -1],
    [-1, 1],
    [1, -1],
    [1, 1],
  ] as const) {
    points.push([field.x + a * x, field.y + b * y, 0], [field.x + a * x, field.y + b * y, WALL_M]);
    if (field.height > WALL_M) {
      points.push([field.x + 0.9 * a * x, field.y + 0.9 * b * y, field.height]);
    }
  }
  return fit(
    points,
    { x: field.x, y: field.y, z: 0, azimuth, elevation, distance: 3 },
    aspect,
    frame,
  );
}

/** Move a shot, keeping its direction, until some points just fill the frame. */
export function fit(
  points: readonly (readonly [number, number, number])[],
  from: Shot,
  aspect: number,
  frame: Frame2d,
): Shot {
  const shot = { ...from };
  const tan = Math.tan(FOV_RAD / 2);
  for (let round = 0; round < 14; round++) {
    const view = viewOf(shot);
    let [left, right, bottom, top] = [Infinity, -Infinity, Infinity, -Infinity];
    for (const [px, py, pz] of points) {
      const at = toView(view, px, py, pz);
      const depth = Math.max(0.05, at[2]);
      const u = at[0] / (depth * tan * aspect);
      const v = at[1] / (depth * tan);
      left = Math.min(left, u);
      right = Math.max(right, u);
      bottom = Math.min(bottom, v);
      top = Math.max(top, v);
    }
    const wide = (right - left) / (frame.right - frame.left);
    const high = (top - bottom) / (frame.top - frame.bottom);
    const middleU = (left + right) / 2 - ((frame.left + frame.right) / 2) * wide;
    const middleV = (top + bottom) / 2 - ((frame.top + frame.bottom) / 2) * high;
    const reach = shot.distance * tan;
    for (const [index, name] of (["x", "y", "z"] as const).entries()) {
      shot[name] +=
        view.right[index]! * middleU * reach * aspect + view.up[index]! * middleV * reach;
    }
    shot.distance *= Math.max(wide, high);
  }
  return shot;
}

/** A camera's place and axes. */
export interface ViewAxes {
  eye: [number, number, number];
  right: [number, number, number];
  up: [number, number, number];
  forward: [number, number, number];
}

export function viewOf({ x, y, z, azimuth, elevation, distance }: Shot): ViewAxes {
  const [ca, sa] = [Math.cos(azimuth), Math.sin(azimuth)];
  const [ce, se] = [Math.cos(elevation), Math.sin(elevation)];
  return {
    eye: [x + distance * ce * ca, y + distance * ce * sa, z + distance * se],
    right: [-sa, ca, 0],
    up: [-se * ca, -se * sa, ce],
    forward: [-ce * ca, -ce * sa, -se],
  };
}

/** Right, up and depth of a point, from the camera. */
export function toView(view: ViewAxes, x: number, y: number, z: number): [number, number, number] {
  const dx = x - view.eye[0];
  const dy = y - view.eye[1];
  const dz = z - view.eye[2];
  const along = ([a, b, c]: [number, number, number]) => a * dx + b * dy + c * dz;
  return [along(view.right), along(view.up), along(view.forward)];
}

/** What a rig needs to know to aim. */
export interface Aim {
  model: Model;
  aspect: number;
  frame: Frame2d;
  /** The seat whose robot the camera follows. */
  seat: number;
}

/** Follows a robot from behind, evenly. */
export class Chaser {
  private shot: Shot | null = null;
  private lastMs = 0;

  follow(robot: Robot, nowMs: number): Shot {
    const goal = {
      x: robot.x + CHASE.ahead_m * Math.cos(robot.heading),
      y: robot.y + CHASE.ahead_m * Math.sin(robot.heading),
      z: 0.05,
      azimuth: robot.heading + Math.PI,
      elevation: CHASE.elevation,
      distance: CHASE.distance,
    };
    const passedMs = Math.min(200, nowMs - this.lastMs);
    this.lastMs = nowMs;
    const shot = this.shot;
    if (!shot || Math.hypot(goal.x - shot.x, goal.y - shot.y) > 0.5) this.shot = goal;
    else {
      const place = 1 - Math.exp(-passedMs / CHASE.place_ms);
      const turn = 1 - Math.exp(-passedMs / CHASE.turn_ms);
      shot.x += (goal.x - shot.x) * place;
      shot.y += (goal.y - shot.y) * place;
      shot.azimuth += turned(shot.azimuth, goal.azimuth) * turn;
    }
    return this.shot!;
  }
}

/** Goes along with a robot, and shows it from the same side whatever it does. */
class Companion {
  private shot: Shot | null = null;
  private lastMs = 0;

  follow(robot: Robot, aspect: number, nowMs: number): Shot {
    // In an upright picture the robot is as wide as the picture.
    const distance = NEAR.distance * Math.max(1, 1.25 / aspect);
    const { elevation, azimuth, z } = NEAR;
    const goal = { x: robot.x, y: robot.y, z, azimuth, elevation, distance };
    const part = 1 - Math.exp(-Math.min(200, nowMs - this.lastMs) / NEAR.place_ms);
    this.lastMs = nowMs;
    const shot = this.shot;
    if (!shot || Math.hypot(goal.x - shot.x, goal.y - shot.y) > 0.2) this.shot = goal;
    else {
      shot.x += (goal.x - shot.x) * part;
      shot.y += (goal.y - shot.y) * part;
      shot.distance = distance;
    }
    return { ...this.shot! };
  }
}

/** Aims the cameras with fixed names. */
export class Rig {
  private readonly chasers = new Map<number, Chaser>();
  private readonly companion = new Companion();
  private key = "";
  private from: Shot | null = null;
  private sinceMs = 0;
  private now: Shot | null = null;
  private fitted: { key: string; model: Model; shot: Shot } | null = null;
  private byHand = { azimuth: 0, elevation: 0, zoom: 1 };

  /** The shot of a camera that is not `auto`. */
  aim(name: CameraName, { model, aspect, frame, seat }: Aim, nowMs: number): Shot {
    switch (name) {
      case "top":
        return this.whole(SOUTH, STRAIGHT_DOWN, model, aspect, frame);
      case "side":
        return this.whole(SOUTH, 0.3, model, aspect, frame);
      case "robot": {
        const robot = model.robots[seat];
        if (robot) return this.companion.follow(robot, aspect, nowMs);
        const { azimuth, elevation, distance, z } = NEAR;
        return { x: 0, y: 0, z, azimuth, elevation, distance };
      }
      case "chase":
      case "left":
      case "right": {
        const whose = name === "left" ? 0 : name === "right" ? 1 : seat;
        return (
          this.chase(whose, model, nowMs) ??
          this.aim("arena", { model, aspect, frame, seat }, nowMs)
        );
      }
      default:
        return this.whole(SOUTH - 0.2, aspect < 0.8 ? 1.05 : 0.78, model, aspect, frame);
    }
  }

  /** As `fitField`, worked out again only when something is different. */
  private whole(
    azimuth: number,
    elevation: number,
    model: Model,
    aspect: number,
    frame: Frame2d,
  ): Shot {
    const { left, right, top, bottom } = frame;
    const key = [azimuth, elevation, aspect, left, right, top, bottom].join();
    if (this.fitted?.key !== key || this.fitted.model !== model) {
      const shot = fitField(model.field, azimuth, elevation, aspect, frame);
      this.fitted = { key, model, shot };
    }
    return { ...this.fitted.shot };
  }

  /** Behind a seat's robot; null while it has none. */
  chase(seat: number, model: Model, nowMs: number): Shot | null {
    const robot = model.robots[seat];
    if (!robot) return null;
    let chaser = this.chasers.get(seat);
    if (!chaser) {
      chaser = new Chaser();
      this.chasers.set(seat, chaser);
    }
    return chaser.follow(robot, nowMs);
  }

  /**
   * Go on toward a shot.
   *
   * @param key Changes when another shot begins: then the camera glides to it.
   */
  move(key: string, goal: Shot, nowMs: number, glideMs = GLIDE_MS): Shot {
    if (key !== this.key) {
      this.from = isCalm.matches ? null : this.now && { ...this.now };
      this.sinceMs = nowMs;
      this.key = key;
      this.byHand = { azimuth: 0, elevation: 0, zoom: 1 };
    }
    const part = this.from ? Math.min(1, (nowMs - this.sinceMs) / glideMs) : 1;
    if (part >= 1) this.from = null;
    const wanted = {
      ...goal,
      azimuth: goal.azimuth + this.byHand.azimuth,
      elevation: Math.min(STRAIGHT_DOWN, Math.max(LOWEST, goal.elevation + this.byHand.elevation)),
      distance: goal.distance * this.byHand.zoom,
    };
    this.now = this.from ? between(this.from, wanted, ease(part)) : wanted;
    return this.now;
  }

  /** Begin the next shot at once, without a glide: it is somewhere else. */
  cut(): void {
    this.now = null;
    this.from = null;
  }

  /** Turn by hand [rad]. */
  orbit(azimuth: number, elevation: number): void {
    const now = this.now?.elevation ?? 0;
    this.byHand.azimuth += azimuth;
    if (now + elevation > LOWEST && now + elevation < STRAIGHT_DOWN) {
      this.byHand.elevation += elevation;
    }
  }

  /** Come nearer by hand: a factor. */
  zoom(factor: number): void {
    this.byHand.zoom = Math.min(2.5, Math.max(0.2, this.byHand.zoom * factor));
  }

  /** Take back what was done by hand. */
  release(): void {
    this.byHand = { azimuth: 0, elevation: 0, zoom: 1 };
  }
}

/** The short way from one angle to another. */
export function turned(from: number, to: number): number {
  const angle = (to - from) % (2 * Math.PI);
  if (angle > Math.PI) return angle - 2 * Math.PI;
  return angle < -Math.PI ? angle + 2 * Math.PI : angle;
}

function between(one: Shot, other: Shot, part: number): Shot {
  const at = (from: number, to: number) => from + (to - from) * part;
  return {
    x: at(one.x, other.x),
    y: at(one.y, other.y),
    z: at(one.z, other.z),
    azimuth: one.azimuth + turned(one.azimuth, other.azimuth) * part,
    elevation: at(one.elevation, other.elevation),
    distance: Math.exp(at(Math.log(one.distance), Math.log(other.distance))),
  };
}

function ease(part: number): number {
  return part * part * part * (part * (6 * part - 15) + 10);
}
