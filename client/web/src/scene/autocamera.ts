/**
 * The automatic camera: the whole field by default, and the action when there is some.
 *
 * It looks only at what is drawn (the markers' changes, the robots' places), so it is right with
 * any delay and in a recording as well.
 */

import { Phase } from "../core/wire";
import { type Aim, FOV_RAD, fit, isCalm, type Rig, type Shot } from "./cameras";
import type { Robot } from "./model";

/** A close shot lasts at least this long while play goes on. */
const LEAST_MS = 4200;
/** A close shot lasts at most this long; then the whole field shows who leads. */
const CLOSE_MOST_MS = 8500;
/** The whole field is shown at least this long. */
const WIDE_LEAST_MS = 8000;
/** Robots that come nearer than this are shown together, until they are `APART_M` apart. */
const NEAR_M = 0.5;
const APART_M = 0.68;
const NEAR_FOR_MS = 500;

const DRIFT_RAD = 0.09;
const DRIFT_MS = 21_000;
const SWAY_RAD = 0.7;
const SWAY_MS = 40_000;
/** Around the winner so much of the field is seen. */
const WINNER_M = 0.42;

type Scene =
  | { kind: "wide" }
  | { kind: "pair" }
  | { kind: "robot"; seat: number }
  | { kind: "end" };

/** Something happened on the drawn field. */
export interface Action {
  /** The seat of the robot that did it. */
  seat: number;
}

/** To one side and the other after the end: left stays left. */
function sway(nowMs: number): number {
  return SWAY_RAD * Math.sin((nowMs / SWAY_MS) * 2 * Math.PI);
}

/** From both sides of the winner, who stays in the free part of the picture. */
function around({ x, y }: Robot, aim: Aim, turned: number): Shot {
  const points = [-WINNER_M, WINNER_M].flatMap((side) => [
    [x + side, y, 0] as const,
    [x, y + side, 0] as const,
    [x, y, side + WINNER_M] as const,
  ]);
  const azimuth = -Math.PI / 2 + turned;
  const from = { x, y, z: 0.05, azimuth, elevation: 0.42, distance: 1.5 };
  return fit(points, from, aim.aspect, aim.frame);
}

export class AutoCamera {
  private scene: Scene = { kind: "wide" };
  private sinceMs = Number.NEGATIVE_INFINITY;
  private nearSinceMs: number | null = null;
  private side = 1;

  constructor(private readonly rig: Rig) {}

  /** The shot to show now; a new key is a new shot. */
  shoot(aim: Aim, actions: readonly Action[], nowMs: number): { key: string; shot: Shot } {
    if (isCalm.matches) return { key: "auto", shot: this.rig.aim("arena", aim, nowMs) };
    this.choose(aim, actions, nowMs);
    const drift = DRIFT_RAD * Math.sin((nowMs / DRIFT_MS) * 2 * Math.PI);
    const { scene } = this;
    const winner = aim.model.robots[aim.model.leader];
    if (scene.kind === "end" && winner)
      return { key: "auto winner", shot: around(winner, aim, sway(nowMs)) };
    const shot = this.frame(aim, nowMs);
    shot.azimuth += scene.kind === "end" ? sway(nowMs) : drift;
    return { key: `auto ${scene.kind}${scene.kind === "robot" ? scene.seat : ""}`, shot };
  }

  private choose({ model }: Aim, actions: readonly Action[], nowMs: number): void {
    const age = nowMs - this.sinceMs;
    const gap = this.gap(model.robots);
    if (gap < NEAR_M) this.nearSinceMs ??= nowMs;
    else if (gap > APART_M) this.nearSinceMs = null;
    if (model.phase === Phase.FINISHED || model.phase === Phase.OFFICIAL) {
      this.go({ kind: "end" }, nowMs);
      return;
    }
    if (model.phase !== Phase.PLAYING) {
      this.go({ kind: "wide" }, nowMs);
      return;
    }
    const { kind } = this.scene;
    if (kind === "end") this.go({ kind: "wide" }, nowMs);
    if (kind === "wide") {
      if (age < WIDE_LEAST_MS) return;
      if (this.nearSinceMs !== null && nowMs - this.nearSinceMs > NEAR_FOR_MS) {
        this.go({ kind: "pair" }, nowMs);
      } else if (actions[0] && model.robots[actions[0].seat]) {
        this.go({ kind: "robot", seat: actions[0].seat }, nowMs);
      }
      return;
    }
    if (age < LEAST_MS) return;
    const over = kind === "pair" && this.nearSinceMs === null;
    if (over || age > CLOSE_MOST_MS || !model.robots.length) this.go({ kind: "wide" }, nowMs);
  }

  private go(scene: Scene, nowMs: number): void {
    if (scene.kind === this.scene.kind) return;
    this.scene = scene;
    this.sinceMs = nowMs;
    this.side = -this.side;
  }

  private gap(robots: Aim["model"]["robots"]): number {
    const [one, other] = robots;
    return one && other ? Math.hypot(one.x - other.x, one.y - other.y) : Number.POSITIVE_INFINITY;
  }

  private frame(aim: Aim, nowMs: number): Shot {
    const { model } = aim;
    const [one, other] = model.robots;
    if (this.scene.kind === "pair" && one && other) {
      // From the south, a little toward the side: left stays left.
      const view = { azimuth: -Math.PI / 2 + 0.35 * this.side, elevation: 0.55 };
      const middle = { x: (one.x + other.x) / 2, y: (one.y + other.y) / 2, z: 0.04 };
      const across = Math.hypot(one.x - other.x, one.y - other.y) / 2 + 0.34;
      const points = [
        [middle.x - across, middle.y, 0],
        [middle.x + across, middle.y, 0],
        [middle.x, middle.y - across, 0],
        [middle.x, middle.y + across, 0.2],
      ] as const;
      const from = { ...middle, ...view, distance: across / Math.tan(FOV_RAD / 2) };
      return this.steady(fit(points, from, aim.aspect, aim.frame), nowMs);
    }
    if (this.scene.kind === "robot") {
      const robot = model.robots[this.scene.seat];
      if (robot) {
        const shot: Shot = {
          x: robot.x,
          y: robot.y,
          z: 0.04,
          azimuth: -Math.PI / 2 + 0.45 * this.side,
          elevation: 0.5,
          distance: aim.aspect < 0.9 ? 2 : 1.5,
        };
        return this.steady(shot, nowMs);
      }
    }
    this.held = null;
    return this.rig.aim("arena", aim, nowMs);
  }

  private held: Shot | null = null;
  private heldMs = 0;

  /** Follow a shot slowly: robots shake as they walk, and the camera must not. */
  private steady(goal: Shot, nowMs: number): Shot {
    const part = 1 - Math.exp(-Math.min(200, nowMs - this.heldMs) / 500);
    this.heldMs = nowMs;
    const held = this.held;
    if (!held) this.held = { ...goal };
    else {
      for (const name of ["x", "y", "z", "distance"] as const) {
        held[name] += (goal[name] - held[name]) * part;
      }
    }
    return { ...this.held!, azimuth: goal.azimuth, elevation: goal.elevation };
  }
}
