/** The numbers of `Frame.poses` at a moment between two frames. */

import { poseStarts } from "../core/fk";
import type { Moment } from "../core/timeline";
import { type Frame, ROOT_FLOATS } from "../core/wire";

/** Farther in one beat than any robot walks: it was put somewhere else. */
const JUMP_M_PER_BEAT = 0.1;

/** Mixes the poses of two frames; the robots' numbers are in `mixed`. */
export class PoseMixer {
  readonly mixed: Float64Array;
  private readonly starts: number[];
  private readonly kept = new WeakMap<Frame, Float32Array>();

  /** @param joints Number of joints of each seat's robot. */
  constructor(joints: readonly number[]) {
    this.starts = poseStarts(joints);
    this.mixed = new Float64Array(this.starts[joints.length]!);
  }

  /** Mix; false if the frames have no such robots. */
  mix({ before, after, part }: Moment): boolean {
    const one = this.floats(before);
    const other = this.floats(after);
    const { length } = this.mixed;
    if (one.length !== length || !length) return false;
    const beats = Math.max(1, after.beat - before.beat);
    for (let seat = 0; seat + 1 < this.starts.length; seat++) {
      const from = this.starts[seat]!;
      const to = this.starts[seat + 1]!;
      if (other.length === length && !jumped(one, other, from, beats)) {
        this.blend(one, other, from, to, part);
      } else for (let at = from; at < to; at++) this.mixed[at] = one[at]!;
    }
    return true;
  }

  private blend(
    one: Float32Array,
    other: Float32Array,
    from: number,
    to: number,
    part: number,
  ): void {
    const { mixed } = this;
    for (let at = from; at < to; at++) mixed[at] = one[at]! + (other[at]! - one[at]!) * part;
    // q and -q are one turn: go the short way round.
    const q = from + 3;
    let dot = 0;
    for (let at = q; at < from + ROOT_FLOATS; at++) dot += one[at]! * other[at]!;
    if (dot >= 0) return;
    for (let at = q; at < from + ROOT_FLOATS; at++) {
      mixed[at] = one[at]! + (-other[at]! - one[at]!) * part;
    }
  }

  /** The bytes need not lie at a multiple of four, so they are copied, once a frame. */
  private floats(frame: Frame): Float32Array {
    let floats = this.kept.get(frame);
    if (!floats) {
      const { poses } = frame;
      floats = new Float32Array(poses.slice().buffer, 0, poses.length >> 2);
      this.kept.set(frame, floats);
    }
    return floats;
  }
}

function jumped(one: Float32Array, other: Float32Array, at: number, beats: number): boolean {
  const x = other[at]! - one[at]!;
  const y = other[at + 1]! - one[at + 1]!;
  const z = other[at + 2]! - one[at + 2]!;
  return Math.hypot(x, y, z) > JUMP_M_PER_BEAT * beats;
}
