/**
 * Pos-data.txt: the way of one robot through a match, for a spreadsheet (rules 2, workshop 4-4).
 *
 * The same file as shared/lacoc_shared/record/pos_data.py writes from the same frames, byte for
 * byte: tests/pages/test_play.py holds one against the other.
 */

import { floats } from "./poses";
import { type Frame, Phase } from "./wire";

const ROOT_FLOATS = 7;
const FLOAT_BYTES = 4;
const BEAT_S = 0.02;
const DEGREES = 180 / Math.PI;

interface Row {
  tick: number;
  pose: Float32Array;
}

/** Collects the ticks of one seat's robot. */
export class PosData {
  private readonly rows: Row[] = [];
  private last: Frame | null = null;
  private tick = 0;
  /** The clock at the first row: not 0 if what came before was not seen, as before a reload. */
  sinceTicks = 0;

  /**
   * @param seat Index of the seat.
   * @param joints Number of joints of each seat's robot, as in the frames to come.
   */
  constructor(
    private readonly seat: number,
    readonly joints: readonly number[],
  ) {}

  get length(): number {
    return this.rows.length;
  }

  /** Add a frame: a row if physics ran in its beat. One that comes too late is left out. */
  add(frame: Frame): void {
    const last = this.last;
    if (last && frame.beat <= last.beat) return;
    this.last = frame;
    if (!physicsRan(frame, last)) return;
    const pose = this.poseOf(frame);
    if (!pose) return;
    if (!this.rows.length) this.sinceTicks = frame.clock_ticks;
    else if (last) {
      // Frames may be lost on the way; while physics runs every beat is a tick.
      this.tick += isPhysics(last.phase) ? frame.beat - last.beat : 1;
    }
    this.rows.push({ tick: this.tick, pose });
  }

  /** The file: tab-separated, one header row, one row for each tick. */
  text(): string {
    const joints = this.joints[this.seat] ?? 0;
    const names = Array.from({ length: joints }, (_, joint) => `j${joint}_deg`);
    const header = ["time_s", "x_m", "y_m", "z_m", "roll_deg", "pitch_deg", "yaw_deg", ...names];
    const lines = [header.join("\t")];
    for (const { tick, pose } of this.rows) {
      const angles = [...eulerZyx(pose), ...pose.subarray(ROOT_FLOATS)];
      const values = [
        tick * BEAT_S,
        ...pose.subarray(0, 3),
        ...angles.map((angle) => angle * DEGREES),
      ];
      lines.push(values.map(sixDecimals).join("\t"));
    }
    return `${lines.join("\n")}\n`;
  }

  /** This seat's part of the poses; null if the frame is of other robots. */
  private poseOf(frame: Frame): Float32Array | null {
    const sizes = this.joints.map((count) => (ROOT_FLOATS + count) * FLOAT_BYTES);
    const start = sizes.slice(0, this.seat).reduce((sum, size) => sum + size, 0);
    if (frame.poses.length !== sizes.reduce((sum, size) => sum + size, 0)) return null;
    return floats(frame.poses.subarray(start, start + sizes[this.seat]!));
  }
}

function isPhysics(phase: number): boolean {
  return phase === Phase.READY || phase === Phase.PLAYING;
}

function physicsRan(frame: Frame, last: Frame | null): boolean {
  if (isPhysics(frame.phase)) return true;
  // The tick that ends a match is played too (rules 4: "tick 9000 is played and judged").
  return (
    frame.phase === Phase.FINISHED &&
    last?.phase === Phase.PLAYING &&
    frame.clock_ticks > last.clock_ticks
  );
}

/** Roll, pitch and yaw [rad] of a pose's quaternion, as kinematics.py has them. */
function eulerZyx(pose: Float32Array): [number, number, number] {
  const [w, x, y, z] = pose.subarray(3, ROOT_FLOATS) as unknown as [number, number, number, number];
  const roll = Math.atan2(2 * (w * x + y * z), 1 - 2 * (x * x + y * y));
  const pitch = Math.asin(Math.min(1, Math.max(-1, 2 * (w * y - z * x))));
  const yaw = Math.atan2(2 * (w * z + x * y), 1 - 2 * (y * y + z * z));
  return [roll, pitch, yaw];
}

/** As Python's `format(value, "z.6f")`: half goes to even, and zero has no sign. */
export function sixDecimals(value: number): string {
  const text = halfToEven(value) ?? value.toFixed(6);
  return text === "-0.000000" ? "0.000000" : text;
}

/**
 * Only odd multiples of 1/128 end with a five at the seventh decimal, exactly: `toFixed` takes
 * those away from zero. A robot on a grid stands at such places.
 */
function halfToEven(value: number): string | null {
  const times = Math.abs(value) * 128;
  if (!Number.isInteger(times) || times % 2 !== 1) return null;
  const up = value.toFixed(6);
  if (Number(up.at(-1)) % 2 === 0) return up;
  return `${up.slice(0, -1)}${Number(up.at(-1)) - 1}`;
}
