/**
 * Pos-data.txt: the way of one robot through a match, for a spreadsheet (rules 2, workshop 4-4).
 *
 * The same file as shared/lacoc_shared/record/export/pos_data.py writes from the same frames, byte for
 * byte: tests/pages/test_play.py holds one against the other.
 */

import { floats } from "./poses";
import { BEAT_S, type Frame, Phase, ROOT_FLOATS, type Sheet, sameBytes } from "./wire";

const FLOAT_BYTES = 4;
const DEGREES = 180 / Math.PI;

/** The number of rows that a page keeps: the newest hour. */
const MOST_ROWS = 3600 / BEAT_S;
const FIRST_ROWS = 1024;
/** A whole file as one text would be tens of megabytes. */
const ROWS_A_PART = 1000;

/** Collects the ticks of one seat's robot. */
export class PosData {
  /** Whether rows before these were forgotten. */
  isCut = false;
  private readonly width: number;
  /** A ring: row `begin` is the oldest. The numbers of a row stand in a row of each of these. */
  private poses: Float32Array;
  private ticks: Uint32Array;
  private clocks: Uint32Array;
  private begin = 0;
  private count = 0;
  private last: Frame | null = null;
  private tick = 0;

  /**
   * @param seat Index of the seat.
   * @param joints Number of joints of each seat's robot, as in the frames to come.
   * @param most How many rows to keep.
   */
  constructor(
    readonly seat: number,
    readonly joints: readonly number[],
    private readonly most = MOST_ROWS,
  ) {
    const rows = Math.min(FIRST_ROWS, most);
    this.width = ROOT_FLOATS + (joints[seat] ?? 0);
    this.poses = new Float32Array(rows * this.width);
    this.ticks = new Uint32Array(rows);
    this.clocks = new Uint32Array(rows);
  }

  get length(): number {
    return this.count;
  }

  /** The clock at the first row: not 0 if what came before was not seen, as before a reload. */
  get sinceTicks(): number {
    return this.count ? this.clocks[this.begin]! : 0;
  }

  /** Add a frame: a row if physics ran in its beat. One that comes too late is left out. */
  add(frame: Frame): void {
    const last = this.last;
    if (last && frame.beat <= last.beat) return;
    this.last = frame;
    if (!physicsRan(frame, last)) return;
    const pose = this.poseOf(frame);
    if (!pose) return;
    if (this.count && last) {
      // Frames may be lost on the way; while physics runs every beat is a tick.
      this.tick += isPhysics(last.phase) ? frame.beat - last.beat : 1;
    }
    const row = this.nextRow();
    this.poses.set(pose, row * this.width);
    this.ticks[row] = this.tick;
    this.clocks[row] = frame.clock_ticks;
  }

  /** The file, in parts: tab-separated, one header row, one row for each tick. */
  parts(): string[] {
    const joints = this.joints[this.seat] ?? 0;
    const names = Array.from({ length: joints }, (_, joint) => `j${joint}_deg`);
    const header = ["time_s", "x_m", "y_m", "z_m", "roll_deg", "pitch_deg", "yaw_deg", ...names];
    const parts = [`${header.join("\t")}\n`];
    for (let from = 0; from < this.count; from += ROWS_A_PART) {
      const to = Math.min(this.count, from + ROWS_A_PART);
      let part = "";
      for (let index = from; index < to; index++) part += `${this.line(index)}\n`;
      parts.push(part);
    }
    return parts;
  }

  private line(index: number): string {
    const row = (this.begin + index) % this.ticks.length;
    const pose = this.poses.subarray(row * this.width, (row + 1) * this.width);
    const angles = [...eulerZyx(pose), ...pose.subarray(ROOT_FLOATS)];
    const values = [
      this.ticks[row]! * BEAT_S,
      ...pose.subarray(0, 3),
      ...angles.map((angle) => angle * DEGREES),
    ];
    return values.map(sixDecimals).join("\t");
  }

  /** Where the next row belongs: behind the others, in the place of the oldest once all are used. */
  private nextRow(): number {
    const room = this.ticks.length;
    if (this.count < room) return this.count++;
    if (room < this.most) {
      const more = Math.min(2 * room, this.most);
      this.poses = grown(this.poses, more * this.width);
      this.ticks = grown(this.ticks, more);
      this.clocks = grown(this.clocks, more);
      return this.count++;
    }
    const oldest = this.begin;
    this.begin = (oldest + 1) % room;
    this.isCut = true;
    return oldest;
  }

  /** This seat's part of the poses; null if the frame is of other robots. */
  private poseOf(frame: Frame): Float32Array | null {
    const sizes = this.joints.map((count) => (ROOT_FLOATS + count) * FLOAT_BYTES);
    const start = sizes.slice(0, this.seat).reduce((sum, size) => sum + size, 0);
    if (frame.poses.length !== sizes.reduce((sum, size) => sum + size, 0)) return null;
    return floats(frame.poses.subarray(start, start + sizes[this.seat]!));
  }
}

/** Collects the rows of the seat that is held; a new match, seat or robot starts a new list. */
export class PosDataLog {
  /** null before the first frame with robots. */
  current: PosData | null = null;
  private match = 0;

  /** Add a frame of the seat with this index; without its sheet it is left out. */
  add(frame: Frame, seat: number, sheet: Sheet | null): void {
    if (!sheet || !frame.poses.length || !sameBytes(frame.scene, sheet.scene)) return;
    const joints = sheet.seats.map(({ legs }) => 3 * legs.length);
    const { current } = this;
    const isSame =
      current?.seat === seat &&
      this.match === frame.match &&
      current.joints.every((count, index) => count === joints[index]);
    if (!isSame) {
      this.current = new PosData(seat, joints);
      this.match = frame.match;
    }
    this.current?.add(frame);
  }
}

function grown<T extends Float32Array | Uint32Array>(numbers: T, length: number): T {
  const longer = new (numbers.constructor as new (length: number) => T)(length);
  longer.set(numbers);
  return longer;
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
