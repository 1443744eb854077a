/** The feet of the posture in the picture: where they are, their ways, and what a drag does to them. */

import { computed, type ReadonlySignal, signal } from "@preact/signals";
import { anglesOf, bring, neighbours, wayOf } from "../../../core/design/feet";
import { jointsOfLeg } from "../../../core/design/parts";
import { Rest } from "../../../core/design/sources";
import { mapRows, type Table, withCells } from "../../../core/design/table";
import { type Leg, points, type Three, type Unreached } from "../../../core/leg/leg";
import { remembered } from "../../../core/settings";
import type { RobotReply } from "../../../core/wire";
import { t } from "../../../i18n";
import type { Annotations, Placed, Placing, Reaching } from "../../../scene/View";
import type { Sheet } from "../table/sheet";

/** A line over the picture; points in the body frame [mm]. */
export interface Line {
  /**
   * The way of a foot through the key's postures, the leg in the posture before or after, or an
   * arrow to the front of the robot.
   */
  kind: "way" | "before" | "after" | "front";
  /** -1: of no leg. */
  leg: number;
  points: readonly Three[];
}

/** A foot that a drag or a key moves. */
interface Moved {
  leg: number;
  /** Where it shall be, in the body frame [mm]: whole degrees come only near it. */
  to: Three;
  /** The table that this led to; another table begins another move. */
  table: Table | null;
}

interface Drag {
  reach: Reaching;
  /** From the pointer to the foot [px], and how far the foot is from the camera [m]. */
  off: Placed;
  /** Height of the body's origin when the drag began [m]: a leg that pushes lifts the body. */
  body_m: number;
}

/** Whether the ways of the feet are shown. */
export const showsWays = remembered("feet-ways", true);

export class Feet implements Annotations {
  /** The robot's legs. */
  readonly legs = computed<readonly Leg[]>(() => this.robot.value?.shapes ?? []);
  /** Root, 1st and 2nd of each leg now. */
  readonly angles = computed<readonly Three[]>(() => {
    const cells = this.sheet.posture.value;
    const start = this.robot.value?.start_deg;
    if (!cells || !start) return [];
    return this.legs.value.map((_, leg) => anglesOf(cells, start, leg));
  });
  /** Each foot in the body frame [mm]. */
  readonly places = computed<readonly Three[]>(() =>
    this.angles.value.map((angles, leg) => points(this.legs.value[leg]!, angles)[3]),
  );
  readonly lines = computed<readonly Line[]>(() => [
    ...this.front.value,
    ...(showsWays.value ? this.linesNow() : []),
  ]);
  /** Why the foot that is moved can't be where it should be. */
  readonly unreached = signal<{ leg: number; why: Unreached } | null>(null);

  /** The elements that lie over the picture, in the order of `places` and of `lines`. */
  readonly handles: (HTMLElement | null)[] = [];
  readonly strokes: (SVGPolylineElement | null)[] = [];

  /** Height of the body's origin [m]. */
  private readonly body_m = computed(() => {
    const [robot, cells] = [this.robot.value, this.sheet.posture.value];
    return robot && cells ? new Rest(robot).poses(cells)[2]! : 0;
  });
  private readonly front = computed<readonly Line[]>(() => {
    const robot = this.robot.value;
    if (!robot) return [];
    const body_mm = 1000 * Number(robot.facts.body_length_m);
    const [from, to] = [body_mm / 2 + 20, body_mm / 2 + 85];
    const points: Three[] = [
      [0, from, 0],
      [0, to, 0],
      [-12, to - 18, 0],
      [0, to, 0],
      [12, to - 18, 0],
    ];
    return [{ kind: "front", leg: -1, points }];
  });
  private place: Placing = () => null;
  private reach: () => Reaching | null = () => null;
  private drag: Drag | null = null;
  private moved: Moved | null = null;
  private gesture = 0;

  constructor(
    private readonly sheet: Sheet,
    private readonly robot: ReadonlySignal<RobotReply | null>,
  ) {}

  get isHeld(): boolean {
    return this.drag !== null;
  }

  draw(place: Placing, reach: () => Reaching | null): void {
    this.place = place;
    this.reach = reach;
    const body_m = this.body_m.peek();
    const at = ([x, y, z]: Three) => place(x / 1000, y / 1000, body_m + z / 1000);
    for (const [leg, foot] of this.places.peek().entries()) {
      const handle = this.handles[leg];
      const found = at(foot);
      if (!handle) continue;
      handle.hidden = !found;
      if (found) handle.style.translate = `${found.x.toFixed(1)}px ${found.y.toFixed(1)}px`;
    }
    for (const [index, line] of this.lines.peek().entries()) {
      const corners = line.points.flatMap((point) => {
        const found = at(point);
        return found ? [`${found.x.toFixed(1)},${found.y.toFixed(1)}`] : [];
      });
      this.strokes[index]?.setAttribute("points", corners.join(" "));
    }
  }

  /** Go to the leg in the table. */
  choose(leg: number): void {
    this.unreached.value = null;
    this.gesture++;
    this.moved = null;
    const col = jointsOfLeg(leg, this.legs.peek().length)[2]!;
    const { row } = this.sheet.active.peek();
    this.sheet.select({ row, col });
  }

  /** Take a foot where the pointer is [px]. */
  take(leg: number, x: number, y: number): void {
    this.choose(leg);
    const reach = this.reach();
    const body_m = this.body_m.peek();
    const [fx, fy, fz] = this.places.peek()[leg]!;
    const foot = this.place(fx / 1000, fy / 1000, body_m + fz / 1000);
    if (!reach || !foot) return;
    this.drag = { reach, off: { x: foot.x - x, y: foot.y - y, far: foot.far }, body_m };
  }

  /** Bring the foot that was taken to where the pointer is [px]. */
  pull(leg: number, x: number, y: number): void {
    if (!this.drag) return;
    const { reach, off, body_m } = this.drag;
    const height_m = body_m + this.places.peek()[leg]![2] / 1000;
    const at = reach({ x: x + off.x, y: y + off.y, far: off.far }, height_m);
    this.bring(leg, [1000 * at[0], 1000 * at[1], 1000 * (at[2] - body_m)]);
  }

  leave(): void {
    this.drag = null;
  }

  /** Move a foot in the body frame [mm]. */
  step(leg: number, by: Three): void {
    const goesOn = this.moved?.leg === leg && this.moved.table === this.sheet.table.peek();
    const from = goesOn ? this.moved!.to : this.places.peek()[leg]!;
    this.bring(leg, from.map((one, axis) => one + by[axis]!) as unknown as Three);
  }

  private bring(leg: number, to: Three): void {
    const shape = this.legs.peek()[leg]!;
    const { angles, unreached } = bring(shape, to, this.angles.peek()[leg]!);
    this.unreached.value = unreached && { leg, why: unreached };
    if (!angles) return;
    const { row } = this.sheet.active.peek();
    const joints = jointsOfLeg(leg, this.legs.peek().length);
    const change = (table: Table): Table =>
      mapRows(table, (one, index) =>
        index === row ? withCells(one, (cell, col) => angles[joints.indexOf(col)] ?? cell) : one,
      );
    this.sheet.edit(t("design.foot.step", { leg: shape.label }), change, `foot ${this.gesture}`);
    this.moved = { leg, to, table: this.sheet.table.peek() };
  }

  private linesNow(): Line[] {
    const [robot, table] = [this.robot.value, this.sheet.table.value];
    const [sequence, { row, col }] = [this.sheet.sequence.value, this.sheet.active.value];
    const beside = neighbours(sequence, row);
    if (!robot || !table || !sequence || !beside) return [];
    const legs = this.legs.value;
    const cellsOf = (one: number) =>
      one === row ? this.sheet.posture.value! : table.rows[one]!.cells;
    const anglesAt = (one: number, leg: number) => anglesOf(cellsOf(one), robot.start_deg, leg);
    const ways = legs.map((shape, leg): Line => {
      const postures = sequence.map((one) => anglesAt(one, leg));
      return { kind: "way", leg, points: wayOf(shape, postures) };
    });
    const leg = col % legs.length;
    const skins = (["before", "after"] as const).map((kind): Line => {
      return { kind, leg, points: points(legs[leg]!, anglesAt(beside[kind], leg)) };
    });
    return [...ways, ...skins];
  }
}
