/** The input of a view: a sheet, its scene, and all positions at a moment. */

import { leaderOf } from "../core/cues";
import { ForwardKinematics, jointsPerSeat } from "../core/fk";
import type { Moment } from "../core/timeline";
import { Phase, type Scene, SeatFlag, type Sheet, sameBytes, unpackStates } from "../core/wire";
import { PoseMixer } from "./poses";

/** The floor between the walls [m, world]. */
export interface Field {
  x: number;
  y: number;
  halfX: number;
  halfY: number;
  /** Height of the highest thing that does not move. */
  height: number;
}

/** A robot at a moment; `heading` is where its +y points [rad, world, 0 along +x]. */
export interface Robot {
  body: number;
  x: number;
  y: number;
  z: number;
  heading: number;
  flags: number;
}

/** Around the markers, where the scene has no floor. */
const MARGIN_M = 0.15;

export class Model {
  readonly fk: ForwardKinematics;
  readonly field: Field;
  /** By seat; empty while no robot is on the field. In a try-out only one seat has its robot. */
  robots: (Robot | undefined)[] = [];
  /** State of each marker. */
  states: readonly number[];
  phase: number = Phase.CREATED;
  /** Seat with the most points; less than 0: several have as many. */
  leader = -1;
  beat = 0;
  match = 0;
  private readonly mixer: PoseMixer;
  private readonly all: Robot[];

  constructor(
    readonly scene: Scene,
    readonly sheet: Sheet,
  ) {
    const joints = jointsPerSeat(sheet);
    this.fk = new ForwardKinematics(scene, joints);
    this.mixer = new PoseMixer(joints);
    this.field = fieldOf(scene, sheet);
    this.states = sheet.markers.map(() => 0);
    this.all = [];
    scene.bodies.forEach((body, index) => {
      if (body.seat < 0) return;
      this.all[body.seat] = { body: index, x: 0, y: 0, z: 0, heading: 0, flags: 0 };
    });
  }

  /** Go to a moment; false if it belongs to another scene. */
  apply(moment: Moment): boolean {
    const { before } = moment;
    if (!sameBytes(before.scene, this.sheet.scene)) return false;
    this.phase = before.phase;
    this.leader = leaderOf(before);
    this.beat = moment.beat;
    this.match = before.match;
    const count = this.sheet.markers.length;
    if (before.markers.length * 4 >= count) this.states = unpackStates(before.markers, count);
    const present = this.all.length > 0 && this.mixer.mix(moment);
    this.robots = present ? this.all : [];
    if (!present) return true;
    this.fk.update(this.mixer.mixed);
    const { pos, quat } = this.fk;
    this.all.forEach((robot, seat) => {
      robot.x = pos[3 * robot.body]!;
      robot.y = pos[3 * robot.body + 1]!;
      robot.z = pos[3 * robot.body + 2]!;
      const [w, x, y, z] = quat.subarray(4 * robot.body) as unknown as number[];
      const alongX = 2 * (x! * y! - w! * z!);
      const alongY = 1 - 2 * (x! * x! + z! * z!);
      // Upright on its nose a robot has no heading: the last one stays.
      if (Math.hypot(alongX, alongY) > 0.05) robot.heading = Math.atan2(alongY, alongX);
      const flags = before.seats[seat]?.flags ?? 0;
      // After the end it is no news that somebody has gone: the winner keeps its colour.
      robot.flags = this.phase < Phase.FINISHED ? flags : flags & ~SeatFlag.SILENT;
    });
    return true;
  }

  /** A body's place [m, world] by its name, for tests. */
  bodyPos(name: string): [number, number, number] | null {
    const index = this.scene.bodies.findIndex((body) => body.name === name);
    if (index < 0) return null;
    const [x, y, z] = this.fk.pos.slice(3 * index, 3 * index + 3);
    return [x!, y!, z!];
  }
}

function fieldOf(scene: Scene, sheet: Sheet): Field {
  let height = 0;
  for (const geom of scene.geoms) {
    if (geom.body !== 0 || geom.type === "plane") continue;
    height = Math.max(height, geom.pos[2] + (geom.type === "box" ? geom.size[2] : geom.size[1]));
  }
  for (const { type, size, pos } of scene.geoms) {
    if (type === "plane" && Math.min(size[0], size[1]) > 0) {
      return { x: pos[0], y: pos[1], halfX: size[0], halfY: size[1], height };
    }
  }
  const reach = (of: (marker: Sheet["markers"][number]) => number) =>
    Math.max(1, ...sheet.markers.map((marker) => Math.abs(of(marker)) + marker.radius_m)) +
    MARGIN_M;
  return { x: 0, y: 0, halfX: reach((m) => m.x_m), halfY: reach((m) => m.y_m), height };
}
