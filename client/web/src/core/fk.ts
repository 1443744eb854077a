/**
 * Forward kinematics: where every body is, from a scene and the poses of a frame.
 *
 * The same computation as `lacoc_shared/record/export/kinematics.py`. Quaternions are w, x, y, z. Everything is
 * Float64: frames are float32, and 1e-6 m would not survive a chain of four float32 rotations.
 */

import { ROOT_FLOATS, type Scene, type Sheet } from "./wire";

/** Number of joints of each seat's robot; 0 while a seat has none. */
export function jointsPerSeat(sheet: Sheet): number[] {
  return sheet.seats.map((seat) => 3 * seat.legs.length);
}

/** Where each seat's numbers begin in `Frame.poses`, and after the last one their count. */
export function poseStarts(joints: readonly number[]): number[] {
  const starts = [0];
  for (const count of joints) starts.push(starts[starts.length - 1]! + ROOT_FLOATS + count);
  return starts;
}

/** Finds the bodies of a scene; nothing is allocated after it was made. */
export class ForwardKinematics {
  /** x, y, z of each body [m, world]. */
  readonly pos: Float64Array;
  /** w, x, y, z of each body, body to world. */
  readonly quat: Float64Array;
  /** Numbers that `update` takes. */
  readonly numbers: number;
  /** For each body the seat of the robot that it belongs to; -1: it never moves. */
  readonly seats: Int32Array;
  private readonly local: Float64Array;
  private readonly axes: Float64Array;
  private readonly parents: Int32Array;
  /** Place of a root's pose in the numbers; -1: not a root. */
  private readonly roots: Int32Array;
  /** Place of a hinge's angle in the numbers; -1: no hinge. */
  private readonly angles: Int32Array;

  /**
   * @param scene As the court sent it; every body comes after its parent.
   * @param joints Number of joints of each seat's robot, as in the frames to come.
   */
  constructor(scene: Scene, joints: readonly number[]) {
    const count = scene.bodies.length;
    const starts = poseStarts(joints);
    this.numbers = starts[joints.length]!;
    this.pos = new Float64Array(3 * count);
    this.quat = new Float64Array(4 * count);
    this.local = new Float64Array(7 * count);
    this.axes = new Float64Array(3 * count);
    this.parents = new Int32Array(count);
    this.roots = new Int32Array(count).fill(-1);
    this.angles = new Int32Array(count).fill(-1);
    this.seats = new Int32Array(count).fill(-1);
    scene.bodies.forEach((body, index) => {
      this.parents[index] = body.parent;
      this.local.set(body.pos, 7 * index);
      this.local.set(body.quat, 7 * index + 3);
      this.axes.set(body.axis, 3 * index);
      const seat = body.seat >= 0 || body.parent < 0 ? body.seat : this.seats[body.parent]!;
      this.seats[index] = seat;
      const start = starts[seat];
      if (start === undefined) return;
      if (body.seat >= 0) this.roots[index] = start;
      else if (body.joint >= 0) this.angles[index] = start + ROOT_FLOATS + body.joint;
    });
    this.update(restPoses(joints));
  }

  /**
   * Find every body.
   *
   * @param poses As in `Frame.poses`; `numbers` of them.
   */
  update(poses: ArrayLike<number>): void {
    const { pos, quat, local, axes, parents } = this;
    for (let body = 0; body < parents.length; body++) {
      const p = 3 * body;
      const q = 4 * body;
      const root = this.roots[body]!;
      if (root >= 0) {
        pos[p] = poses[root]!;
        pos[p + 1] = poses[root + 1]!;
        pos[p + 2] = poses[root + 2]!;
        this.unit(q, poses[root + 3]!, poses[root + 4]!, poses[root + 5]!, poses[root + 6]!);
        continue;
      }
      const l = 7 * body;
      let w = local[l + 3]!;
      let x = local[l + 4]!;
      let y = local[l + 5]!;
      let z = local[l + 6]!;
      const angle = this.angles[body]!;
      if (angle >= 0) {
        const half = poses[angle]! / 2;
        const c = Math.cos(half);
        const s = Math.sin(half);
        const ax = s * axes[p]!;
        const ay = s * axes[p + 1]!;
        const az = s * axes[p + 2]!;
        const w0 = w;
        const x0 = x;
        const y0 = y;
        w = w0 * c - x0 * ax - y0 * ay - z * az;
        x = w0 * ax + x0 * c + y0 * az - z * ay;
        y = w0 * ay - x0 * az + y0 * c + z * ax;
        z = w0 * az + x0 * ay - y0 * ax + z * c;
      }
      const parent = parents[body]!;
      let px = local[l]!;
      let py = local[l + 1]!;
      let pz = local[l + 2]!;
      if (parent >= 0) {
        const a = quat[4 * parent]!;
        const b = quat[4 * parent + 1]!;
        const c = quat[4 * parent + 2]!;
        const d = quat[4 * parent + 3]!;
        const tx = 2 * (c * pz - d * py);
        const ty = 2 * (d * px - b * pz);
        const tz = 2 * (b * py - c * px);
        const x0 = px;
        const y0 = py;
        px = pos[3 * parent]! + x0 + a * tx + c * tz - d * ty;
        py = pos[3 * parent + 1]! + y0 + a * ty + d * tx - b * tz;
        pz = pos[3 * parent + 2]! + pz + a * tz + b * ty - c * tx;
        const w1 = w;
        const x1 = x;
        const y1 = y;
        w = a * w1 - b * x1 - c * y1 - d * z;
        x = a * x1 + b * w1 + c * z - d * y1;
        y = a * y1 - b * z + c * w1 + d * x1;
        z = a * z + b * y1 - c * x1 + d * w1;
      }
      pos[p] = px;
      pos[p + 1] = py;
      pos[p + 2] = pz;
      quat[q] = w;
      quat[q + 1] = x;
      quat[q + 2] = y;
      quat[q + 3] = z;
    }
  }

  /** A frame's quaternion is rounded to float32: make its length 1 again. */
  private unit(q: number, w: number, x: number, y: number, z: number): void {
    const length = Math.hypot(w, x, y, z) || 1;
    this.quat[q] = w / length;
    this.quat[q + 1] = x / length;
    this.quat[q + 2] = y / length;
    this.quat[q + 3] = z / length;
  }
}

/** Robots at the origin with every angle 0. */
function restPoses(joints: readonly number[]): Float64Array {
  const starts = poseStarts(joints);
  const poses = new Float64Array(starts[joints.length]!);
  for (const start of starts.slice(0, -1)) poses[start + 3] = 1;
  return poses;
}
