/** Makes what the 3D view shows on this page: a robot in a posture, or in a trial. */

import { computed, type ReadonlySignal } from "@preact/signals";
import { ForwardKinematics } from "../fk";
import type { Match } from "../match";
import type { Moment } from "../timeline";
import { type Frame, Phase, type RobotReply, type Scene } from "../wire";
import type { Cell } from "./table";
import type { Trial } from "./trial";

/** The `Source` of scene/View.tsx. */
export type Source = Pick<Match, "sheet" | "scene" | "sample">;

/** What is shown: a trial at a tick (may have a fraction), or angles by joint id [deg]. */
export type Shown = { trial: Trial; tick: number } | { cells: readonly Cell[] };

const RADIANS = Math.PI / 180;

/** Show a robot in a trial. The same source stays while the tick moves. */
export function trialSource(robot: RobotReply, trial: Trial, tick: ReadonlySignal<number>): Source {
  return source(
    computed(() => robot),
    computed(() => ({ trial, tick: tick.value })),
  );
}

/** Show a posture or a trial, whichever `shown` says now; the same source stays when it changes. */
export function source(
  robot: ReadonlySignal<RobotReply | null>,
  shown: ReadonlySignal<Shown | null>,
): Source {
  let rest: Rest | null = null;
  let walk: TrialFrames | null = null;
  let count = 0;
  const moment = computed<Moment | null>(() => {
    const [now, of] = [shown.value, robot.value];
    if (!now || !of) return null;
    if ("cells" in now) {
      if (rest?.robot !== of) rest = new Rest(of);
      const frame = frameOf(of, ++count, rest.poses(now.cells));
      return { before: frame, after: frame, part: 0, beat: frame.beat };
    }
    if (walk?.trial !== now.trial || walk.robot !== of) walk = new TrialFrames(of, now.trial);
    return walk.at(now.tick);
  });
  return {
    sheet: computed(() => robot.value?.sheet ?? null),
    scene: computed(() => robot.value?.scene ?? null),
    sample: () => moment.value,
  };
}

/** The frames of a trial; each is made when it is shown first. */
class TrialFrames {
  private readonly frames: (Frame | undefined)[] = [];

  constructor(
    readonly robot: RobotReply,
    readonly trial: Trial,
  ) {}

  at(tick: number): Moment | null {
    const last = this.trial.ticks - 1;
    if (last < 0) return null;
    const beat = Math.min(last, Math.max(0, tick));
    const whole = Math.floor(beat);
    const after = this.frame(Math.min(last, whole + 1));
    return { before: this.frame(whole), after, part: beat - whole, beat };
  }

  private frame(tick: number): Frame {
    this.frames[tick] ??= frameOf(this.robot, tick, posesAt(this.trial, tick));
    return this.frames[tick];
  }
}

/** Puts a robot on the floor: its body is level, and its lowest part touches the floor. */
export class Rest {
  private readonly fk: ForwardKinematics;

  constructor(readonly robot: RobotReply) {
    this.fk = new ForwardKinematics(robot.scene, [robot.start_deg.length]);
  }

  /** `Frame.poses` of a posture [deg]; a cell without an angle has that of the start posture. */
  poses(cells: readonly Cell[]): Float32Array {
    const { start_deg, scene } = this.robot;
    const angles = start_deg.map((start, id) => {
      const cell = cells[id];
      return (typeof cell === "number" ? cell : start) * RADIANS;
    });
    const poses = new Float32Array([0, 0, 0, 1, 0, 0, 0, ...angles]);
    this.fk.update(poses);
    poses[2] = -lowestM(scene, this.fk);
    return poses;
  }
}

/** Height of the lowest point of all robots [m, world]; 0 without a robot. */
export function lowestM(scene: Scene, fk: ForwardKinematics): number {
  let lowest = Number.POSITIVE_INFINITY;
  for (const geom of scene.geoms) {
    if (fk.seats[geom.body]! < 0) continue;
    const turn = times(fk.quat.subarray(4 * geom.body, 4 * geom.body + 4), geom.quat);
    const up = axesUp(turn);
    const [x, y, z] = geom.pos;
    const [bx, by, bz] = axesUp(fk.quat.subarray(4 * geom.body, 4 * geom.body + 4));
    const middle = fk.pos[3 * geom.body + 2]! + bx * x + by * y + bz * z;
    lowest = Math.min(lowest, middle - reach(geom.type, geom.size, up));
  }
  return Number.isFinite(lowest) ? lowest : 0;
}

/** How far below its middle a shape reaches [m]; `up`: the world's up in the shape's axes. */
function reach(type: string, size: readonly [number, number, number], up: Three): number {
  const [x, y, z] = up.map(Math.abs) as Three;
  if (type === "sphere") return size[0];
  if (type === "capsule") return size[0] + size[1] * z;
  if (type === "cylinder") return size[0] * Math.hypot(x, y) + size[1] * z;
  if (type === "ellipsoid") return Math.hypot(size[0] * x, size[1] * y, size[2] * z);
  return size[0] * x + size[1] * y + size[2] * z;
}

type Three = [number, number, number];

/** The world's z of the three axes of a turned frame. */
function axesUp([w, x, y, z]: ArrayLike<number> & Iterable<number>): Three {
  const q = [w, x, y, z] as unknown as [number, number, number, number];
  return [
    2 * (q[1] * q[3] - q[0] * q[2]),
    2 * (q[2] * q[3] + q[0] * q[1]),
    1 - 2 * (q[1] * q[1] + q[2] * q[2]),
  ];
}

function times(one: ArrayLike<number>, other: ArrayLike<number>): number[] {
  const [a, b, c, d] = [one[0]!, one[1]!, one[2]!, one[3]!];
  const [w, x, y, z] = [other[0]!, other[1]!, other[2]!, other[3]!];
  return [
    a * w - b * x - c * y - d * z,
    a * x + b * w + c * z - d * y,
    a * y - b * z + c * w + d * x,
    a * z + b * y - c * x + d * w,
  ];
}

function posesAt({ poses, ticks }: Trial, tick: number): Float32Array {
  const width = poses.length / ticks;
  return poses.slice(tick * width, (tick + 1) * width);
}

function frameOf(robot: RobotReply, beat: number, poses: Float32Array): Frame {
  return {
    match: 0,
    beat,
    phase: Phase.PLAYING,
    countdown_beats: 0,
    clock_ticks: beat,
    seats: [],
    markers: new Uint8Array((robot.sheet.markers.length + 3) >> 2),
    poses: new Uint8Array(poses.buffer),
    scene: robot.sheet.scene,
    digest: new Uint8Array(),
  };
}
