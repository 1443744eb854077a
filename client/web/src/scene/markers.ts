/** Markers as they change: discs turn over, flags fall. */

import { Matrix4, Vector3 } from "three";
import type { MarkerInfo, Scene } from "../core/wire";

export const CHANGE_MS = 420;
/** A shape whose middle is higher than this falls over; all others turn over. */
const TALL_M = 0.05;
/** Share of its radius by which a disc is lifted, so that it does not cut the floor. */
const LIFT = 1.05;
const QUARTER = Math.PI / 2;

/** How the shapes of one state of a marker stand now. */
export interface Posture {
  state: number;
  /** Moves the shapes from where the scene has them; null: not at all. */
  matrix: Matrix4 | null;
  /** 0 at the beginning of a change, 1 when nothing moves. */
  part: number;
}

/** One marker's change. */
interface Change {
  from: number;
  sinceMs: number;
}

/** Data of a marker's shapes in one state. */
interface Form {
  tall: boolean;
  /** Where the shapes' middle is from the marker's own point. */
  x: number;
  y: number;
}

export class MarkerMotion {
  /** True if anything must be redrawn. */
  stale = false;
  private states: readonly number[] = [];
  private readonly changes = new Map<number, Change>();
  private readonly forms: Map<number, Form>[];
  private readonly matrices: Matrix4[];
  private readonly step = new Matrix4();

  constructor(
    scene: Scene,
    private readonly markers: readonly MarkerInfo[],
  ) {
    this.forms = markers.map((marker, index) => formsOf(scene, marker, index));
    this.matrices = markers.map(() => new Matrix4());
  }

  /** True if shapes of a marker stand upright in its first state. */
  isTall(marker: number): boolean {
    return this.forms[marker]?.get(0)?.tall ?? false;
  }

  /**
   * Follow the states.
   *
   * @param animate True: show a change as a movement; false after a jump in time.
   * @returns Markers that changed.
   */
  follow(states: readonly number[], nowMs: number, animate: boolean): number[] {
    const changed: number[] = [];
    // A change that is over is drawn once more, at its end.
    this.stale = this.moving;
    if (states !== this.states) {
      states.forEach((state, marker) => {
        const from = this.states[marker];
        if (from === state) return;
        changed.push(marker);
        if (animate && from !== undefined) this.changes.set(marker, { from, sinceMs: nowMs });
        else this.changes.delete(marker);
      });
      this.states = states;
    }
    for (const [marker, { sinceMs }] of this.changes) {
      if (nowMs - sinceMs > CHANGE_MS || nowMs < sinceMs) this.changes.delete(marker);
    }
    this.stale ||= changed.length > 0;
    return changed;
  }

  /** True while a marker moves to another state. */
  get moving(): boolean {
    return this.changes.size > 0;
  }

  /** How a marker stands now. */
  posture(marker: number, nowMs: number): Posture {
    const state = this.states[marker] ?? 0;
    const change = this.changes.get(marker);
    if (!change) return { state, matrix: null, part: 1 };
    const part = Math.min(1, (nowMs - change.sinceMs) / CHANGE_MS);
    const forms = this.forms[marker]!;
    const from = forms.get(change.from);
    const to = forms.get(state);
    if (from?.tall && to && !to.tall) {
      if (part >= 1) return { state, matrix: null, part };
      return { state: change.from, matrix: this.fall(marker, to, fallen(part)), part };
    }
    if (to?.tall && from && !from.tall) {
      return { state, matrix: this.fall(marker, from, 1 - smooth(part)), part };
    }
    const turned = smooth(part) * Math.PI;
    if (turned < QUARTER) return { state: change.from, matrix: this.turn(marker, turned), part };
    return { state, matrix: this.turn(marker, turned - Math.PI), part };
  }

  /** Over a line across the marker, up and down again. */
  private turn(marker: number, angleRad: number): Matrix4 {
    const { x_m, y_m, radius_m } = this.markers[marker]!;
    const matrix = this.matrices[marker]!;
    const lift = LIFT * radius_m * Math.abs(Math.sin(angleRad));
    matrix.makeTranslation(x_m, y_m, lift);
    matrix.multiply(this.step.makeRotationX(angleRad));
    return matrix.multiply(this.step.makeTranslation(-x_m, -y_m, 0));
  }

  /**
   * About the foot toward where it lies, by 0 to 1; on the way the cloth turns out of the plane in
   * which it would dive into the floor.
   */
  private fall(marker: number, lying: Form, part: number): Matrix4 {
    const { x_m, y_m } = this.markers[marker]!;
    const matrix = this.matrices[marker]!;
    const length = Math.hypot(lying.x, lying.y) || 1;
    axis.set(-lying.y / length, lying.x / length, 0);
    matrix.makeTranslation(x_m, y_m, 0);
    matrix.multiply(this.step.makeRotationAxis(axis, part * QUARTER));
    matrix.multiply(this.step.makeRotationZ(Math.min(1, 2 * part) * QUARTER));
    return matrix.multiply(this.step.makeTranslation(-x_m, -y_m, 0));
  }
}

const axis = new Vector3();

function formsOf(scene: Scene, marker: MarkerInfo, index: number): Map<number, Form> {
  const forms = new Map<number, Form>();
  const geoms = scene.geoms.filter((geom) => geom.marker === index);
  for (const state of new Set(geoms.map((geom) => geom.state))) {
    const mine = geoms.filter((geom) => geom.state === state);
    // The foot of the longest shape is at the marker: it tells the direction of the fall.
    const longest = mine.reduce((one, other) =>
      Math.max(...other.size) > Math.max(...one.size) ? other : one,
    );
    forms.set(state, {
      tall: longest.pos[2] > TALL_M,
      x: longest.pos[0] - marker.x_m,
      y: longest.pos[1] - marker.y_m,
    });
  }
  return forms;
}

function smooth(part: number): number {
  return part * part * (3 - 2 * part);
}

/** Faster and faster, then a small bounce. */
function fallen(part: number): number {
  const hit = 0.72;
  if (part < hit) return (part / hit) ** 2;
  const after = (part - hit) / (1 - hit);
  return 1 - 0.07 * Math.sin(Math.PI * after);
}
