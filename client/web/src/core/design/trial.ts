/** Reads a trial's measurements, tick by tick; a tick is 20 ms. */

import { type Flat, hull } from "../hull";
import { ROOT_FLOATS, type Sentence, type TrialReply } from "../wire";
import { LEVELS } from "./table";

export interface Trial {
  readonly reply: TrialReply;
  readonly legs: number;
  readonly ticks: number;
  /** (ticks,) index of the target posture in the key's sequence. */
  readonly posture: Uint8Array;
  /** (ticks,) bit i is set while the foot of leg i is down. */
  readonly down: Uint8Array;
  /** (ticks, 7 + joints) as `Frame.poses`. */
  readonly poses: Float32Array;
  /** (ticks, joints) commanded joint angles. */
  readonly commandedRad: Float32Array;
  /** (ticks, legs, 2) where each shank touches the floor [m, world]; 0 without contact. */
  readonly contactM: Float32Array;
  /** (ticks, 2) centre of mass in the plane of the floor [m, world]. */
  readonly centreM: Float32Array;
  /** (ticks,) support margin [m]; NaN while no foot is down. */
  readonly marginM: Float32Array;
  /** (ticks, legs) speed of each shank along the floor [m/s]. */
  readonly slipMS: Float32Array;
  /** (ticks, legs) height of each foot's lowest point [m]. */
  readonly tipM: Float32Array;
}

/** The ticks from `from` up to, but without, `to`. */
export interface Run {
  readonly from: number;
  readonly to: number;
}

/** The feet that carry the robot at a tick, in the plane of the floor [m, world]. */
export interface Support {
  /** The legs whose feet are down, and where each foot stands. */
  readonly feet: readonly { leg: number; at: Flat }[];
  /** Corners of the feet's convex hull, counter-clockwise. */
  readonly corners: readonly Flat[];
  readonly centre: Flat;
  /** Null while no foot is down. */
  readonly marginM: number | null;
}

/**
 * Read the reply to a trial.
 *
 * @throws RangeError If the length of an array does not fit the number of ticks and legs.
 */
export function readTrial(reply: TrialReply, legs: number): Trial {
  const { ticks } = reply;
  const joints = LEVELS.length * legs;
  const bytes = (data: Uint8Array) => sized(data, ticks, 1);
  // The arrays may lie at any byte of the message, so each is copied.
  const floats = (data: Uint8Array, each: number) =>
    new Float32Array(new Uint8Array(sized(data, ticks * each, 4)).buffer);
  return {
    reply,
    legs,
    ticks,
    posture: bytes(reply.posture),
    down: bytes(reply.down),
    poses: floats(reply.poses, ROOT_FLOATS + joints),
    commandedRad: floats(reply.commanded_rad, joints),
    contactM: floats(reply.contact_w_m, 2 * legs),
    centreM: floats(reply.centre_w_m, 2),
    marginM: floats(reply.margin_m, 1),
    slipMS: floats(reply.slip_m_s, legs),
    tipM: floats(reply.tip_m, legs),
  };
}

/** Whether a foot is down at a tick. */
export function isDown(trial: Trial, leg: number, tick: number): boolean {
  return ((trial.down[tick]! >> leg) & 1) === 1;
}

/** For each leg, the runs of ticks in which its foot is down, within the ticks of a range. */
export function footBars(trial: Trial, from = 0, to = trial.ticks): Run[][] {
  return Array.from({ length: trial.legs }, (_, leg) =>
    runsOf(from, to, (tick) => isDown(trial, leg, tick)),
  );
}

/** The runs of ticks with the same target posture; a new cycle begins a new run. */
export function postureRuns(trial: Trial): (Run & { posture: number })[] {
  const found: (Run & { posture: number })[] = [];
  for (let from = 0; from < trial.ticks; ) {
    let to = from + 1;
    const isStart = (tick: number) => trial.reply.starts.includes(tick);
    while (to < trial.ticks && trial.posture[to] === trial.posture[from] && !isStart(to)) to++;
    found.push({ from, to, posture: trial.posture[from]! });
    from = to;
  }
  return found;
}

/** Find the feet that carry the robot at a tick. */
export function support(trial: Trial, tick: number): Support {
  const feet = Array.from({ length: trial.legs }, (_, leg) => leg)
    .filter((leg) => isDown(trial, leg, tick))
    .map((leg) => ({ leg, at: pointOf(trial.contactM, tick * trial.legs + leg) }));
  const marginM = trial.marginM[tick]!;
  return {
    feet,
    corners: hull(feet.map(({ at }) => at)),
    centre: pointOf(trial.centreM, tick),
    marginM: Number.isNaN(marginM) ? null : marginM,
  };
}

/** What is drawn on the floor at a tick: what carries the robot, and its path. */
export function floorMarks(trial: Trial, tick: number, way: Float32Array) {
  const { corners, centre, marginM } = support(trial, tick);
  const isStable = marginM !== null && marginM > 0;
  return { polygon: corners, centre, isStable, way, done: tick };
}

/** The path of the body seen from above: a point for each tick [m, world]. */
export function pathOf(trial: Trial): Flat[] {
  const width = trial.poses.length / Math.max(1, trial.ticks);
  return Array.from({ length: trial.ticks }, (_, tick) => [
    trial.poses[tick * width]!,
    trial.poses[tick * width + 1]!,
  ]);
}

/** A figure by its name; null if the trial has no such number. */
export function figure(figures: Record<string, unknown>, name: string): number | null {
  const value = figures[name];
  return typeof value === "number" && Number.isFinite(value) ? value : null;
}

/** The index of the leg that a sentence is about; null: it is about the whole robot. */
export function legOf({ leg }: Sentence): number | null {
  return leg < 0 ? null : leg;
}

function runsOf(from: number, to: number, is: (tick: number) => boolean): Run[] {
  const runs: Run[] = [];
  let begin = -1;
  for (let tick = from; tick <= to; tick++) {
    const on = tick < to && is(tick);
    if (on && begin < 0) begin = tick;
    if (on || begin < 0) continue;
    runs.push({ from: begin, to: tick });
    begin = -1;
  }
  return runs;
}

function pointOf(numbers: Float32Array, index: number): Flat {
  return [numbers[2 * index]!, numbers[2 * index + 1]!];
}

function sized(data: Uint8Array, count: number, bytes: number): Uint8Array {
  if (data.length === count * bytes) return data;
  throw new RangeError(`${data.length} bytes instead of ${count * bytes}`);
}
