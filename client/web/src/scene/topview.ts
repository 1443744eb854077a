/** The field from straight above, drawn in two dimensions: needs no WebGL, and is easily read. */

import { borderOf, ownLabel } from "../core/border";
import { MARKER_STATES, type MarkerInfo, SeatFlag, type Sheet } from "../core/wire";
import { drawLinks, drawMarks } from "./links";
import type { FloorMarks } from "./marks";
import type { Field, Model } from "./model";
import { afflicted, css, evening, luma, mix, partner, type Rgb, rgb } from "./palette";

const FLOOR = "#1f2733";
const WALL = "#56627a";
const LINE = "rgb(255 255 255 / 7%)";
const NEUTRAL: Rgb = [0.36, 0.4, 0.47];
const FALLEN: Rgb = [0.23, 0.26, 0.31];
const DARK = "#10141b";
const LIGHT = "#f4f7fb";
const WALL_M = 0.045;
const GRID_M = 0.1;
const LEAST_MARKER_M = 0.036;
/** Height of the number of a corner or flag. */
const NAME_M = 0.045;
const ROBOT_M = 0.115;

/** Where the field is in the picture [px]. */
export interface Plan {
  scale: number;
  x: number;
  y: number;
}

/** A letter for each seat; numbers where two seats begin alike. */
export function seatLetters(sheet: Sheet): string[] {
  const letters = sheet.seats.map((seat) => seat.id.slice(0, 1).toUpperCase());
  const different = new Set(letters).size === letters.length;
  return different ? letters : letters.map((_, index) => String(index + 1));
}

/** The largest plan within a box [px]. */
export function planOf(
  field: Field,
  box: { left: number; top: number; width: number; height: number },
): Plan {
  const wide = 2 * (field.halfX + WALL_M);
  const high = 2 * (field.halfY + WALL_M);
  const scale = Math.max(1, Math.min(box.width / wide, box.height / high));
  return {
    scale,
    x: box.left + box.width / 2 - field.x * scale,
    y: box.top + box.height / 2 + field.y * scale,
  };
}

export class TopView {
  private readonly context: CanvasRenderingContext2D;
  private ratio = 1;

  constructor(readonly canvas: HTMLCanvasElement) {
    const context = canvas.getContext("2d");
    if (!context) throw new Error("no 2D canvas");
    this.context = context;
  }

  resize(width: number, height: number, ratio: number): void {
    this.ratio = ratio;
    this.canvas.width = Math.round(width * ratio);
    this.canvas.height = Math.round(height * ratio);
  }

  /**
   * Draw.
   *
   * @param ring What is pointed at.
   * @param near What is drawn of robots that are looked at from near; null: arrows are enough.
   */
  draw(
    model: Model,
    plan: Plan,
    ring: { x: number; y: number; radius: number } | null,
    near: { lit: ReadonlyMap<number, number>; marks: FloorMarks | null } | null = null,
  ): void {
    const { context } = this;
    context.setTransform(1, 0, 0, 1, 0, 0);
    context.clearRect(0, 0, this.canvas.width, this.canvas.height);
    // Metres, y up.
    const s = plan.scale * this.ratio;
    context.setTransform(s, 0, 0, -s, plan.x * this.ratio, plan.y * this.ratio);
    this.floor(model.field);
    const letters = seatLetters(model.sheet);
    for (const [index, marker] of model.sheet.markers.entries()) {
      this.marker(marker, model.states[index] ?? 0, model, letters);
    }
    this.border(model);
    if (near?.marks) drawMarks(context, near.marks);
    if (near) {
      if (model.robots.length) drawLinks(context, model, near.lit);
    } else
      for (const seat of model.robots.keys())
        if (model.robots[seat]) this.robot(seat, model, letters[seat] ?? "");
    if (ring) {
      context.lineWidth = 0.012;
      context.strokeStyle = LIGHT;
      this.circle(ring.x, ring.y, ring.radius);
      context.stroke();
    }
  }

  private floor({ x, y, halfX, halfY }: Field): void {
    const { context } = this;
    const wall = WALL_M;
    context.fillStyle = WALL;
    context.beginPath();
    context.roundRect(
      x - halfX - wall,
      y - halfY - wall,
      2 * (halfX + wall),
      2 * (halfY + wall),
      0.03,
    );
    context.fill();
    context.fillStyle = FLOOR;
    context.fillRect(x - halfX, y - halfY, 2 * halfX, 2 * halfY);
    context.strokeStyle = LINE;
    context.lineWidth = 0.003;
    context.beginPath();
    for (let at = Math.ceil((x - halfX) / GRID_M); at * GRID_M < x + halfX; at++) {
      context.moveTo(at * GRID_M, y - halfY);
      context.lineTo(at * GRID_M, y + halfY);
    }
    for (let at = Math.ceil((y - halfY) / GRID_M); at * GRID_M < y + halfY; at++) {
      context.moveTo(x - halfX, at * GRID_M);
      context.lineTo(x + halfX, at * GRID_M);
    }
    context.stroke();
  }

  /** Letters of columns and numbers of rows on the wall. */
  private border({ field: { x, y, halfX, halfY }, sheet }: Model): void {
    const { columns, rows } = borderOf(sheet.markers);
    for (const [text, at] of columns) this.text(text, at, y - halfY - WALL_M / 2, WALL_M, LIGHT);
    for (const [text, at] of rows) this.text(text, x - halfX - WALL_M / 2, at, WALL_M, LIGHT);
  }

  private marker(marker: MarkerInfo, state: number, model: Model, letters: string[]): void {
    const { context } = this;
    const small = marker.radius_m < LEAST_MARKER_M;
    const radius = Math.max(LEAST_MARKER_M, marker.radius_m);
    const seat = model.sheet.seats[state - 1];
    const taken = seat && MARKER_STATES[state] !== "down" ? seat : null;
    const fallen = MARKER_STATES[state] === "down" || (small && state > 0);
    const own = small && state === 0 ? this.cloth(model, marker) : null;
    const colour = taken ? rgb(taken.colour) : (own ?? (fallen ? FALLEN : NEUTRAL));
    const size = small && state > 0 ? 0.75 * radius : radius;
    context.fillStyle = css(colour);
    this.circle(marker.x_m, marker.y_m, size);
    context.fill();
    if (taken) this.pattern(taken.pattern, colour, marker.x_m, marker.y_m, size);
    context.strokeStyle = fallen ? "rgb(255 255 255 / 18%)" : "rgb(255 255 255 / 38%)";
    context.lineWidth = small && state === 0 ? 0.008 : 0.004;
    this.circle(marker.x_m, marker.y_m, size);
    context.stroke();
    const worth = state === 0 && (small || marker.points > 1);
    const value = worth ? String(marker.points) : "";
    const text = taken ? (letters[state - 1] ?? "") : value;
    const name = ownLabel(marker);
    if (name) this.text(name, marker.x_m, marker.y_m - size - 0.6 * NAME_M, NAME_M, LIGHT);
    if (!text) return;
    const ink = luma(colour) > 0.5 ? DARK : LIGHT;
    if (taken) this.plate(marker.x_m, marker.y_m, size, colour);
    this.text(text, marker.x_m, marker.y_m, (small ? 1.25 : 0.72) * size, ink);
  }

  /** A flag's own colour says what it is worth. */
  private cloth(model: Model, marker: MarkerInfo): Rgb | null {
    const index = model.sheet.markers.indexOf(marker);
    const geom = model.scene.geoms.find(
      ({ marker: of, state, type }) => of === index && state === 0 && type === "box",
    );
    return geom ? evening(geom.rgba.slice(0, 3) as unknown as Rgb) : null;
  }

  /** Behind a letter the pattern is left out. */
  private plate(x: number, y: number, radius: number, colour: Rgb): void {
    if (radius < 0.05) return;
    this.context.fillStyle = css(colour);
    this.circle(x, y, 0.5 * radius);
    this.context.fill();
  }

  private pattern(name: string, colour: Rgb, x: number, y: number, radius: number): void {
    if (name !== "stripes" && name !== "dots") return;
    const { context } = this;
    context.save();
    this.circle(x, y, radius);
    context.clip();
    const other = css(mix(colour, partner(colour), 0.8));
    const step = Math.max(0.022, radius / 3.2);
    if (name === "stripes") {
      context.strokeStyle = other;
      context.lineWidth = 0.4 * step;
      context.beginPath();
      for (let at = -2 * radius; at <= 2 * radius; at += step) {
        context.moveTo(x + at - radius, y - radius);
        context.lineTo(x + at + radius, y + radius);
      }
      context.stroke();
    } else {
      context.fillStyle = other;
      for (let row = -4; row <= 4; row++) {
        for (let column = -4; column <= 4; column++) {
          this.circle(x + column * step, y + row * step, 0.26 * step);
          context.fill();
        }
      }
    }
    context.restore();
  }

  private robot(seat: number, model: Model, letter: string): void {
    const { context } = this;
    const robot = model.robots[seat]!;
    const info = model.sheet.seats[seat];
    const colour = afflicted(rgb(info?.colour ?? "#888888"), robot.flags);
    context.save();
    context.translate(robot.x, robot.y);
    context.rotate(robot.heading);
    context.beginPath();
    context.moveTo(1.25 * ROBOT_M, 0);
    context.lineTo(-0.85 * ROBOT_M, 0.85 * ROBOT_M);
    context.lineTo(-0.5 * ROBOT_M, 0);
    context.lineTo(-0.85 * ROBOT_M, -0.85 * ROBOT_M);
    context.closePath();
    context.lineJoin = "round";
    context.lineWidth = 0.034;
    context.strokeStyle = DARK;
    context.stroke();
    context.lineWidth = 0.02;
    context.strokeStyle = LIGHT;
    context.stroke();
    context.fillStyle = css(mix(colour, [1, 1, 1], 0.12));
    context.fill();
    context.restore();
    const ink = luma(colour) > 0.5 ? DARK : LIGHT;
    this.text(letter, robot.x, robot.y, 0.75 * ROBOT_M, ink);
    if (robot.flags & (SeatFlag.SILENT | SeatFlag.FROZEN)) {
      context.setLineDash([0.03, 0.02]);
      context.lineWidth = 0.01;
      context.strokeStyle = LIGHT;
      this.circle(robot.x, robot.y, 1.45 * ROBOT_M);
      context.stroke();
      context.setLineDash([]);
    }
  }

  private circle(x: number, y: number, radius: number): void {
    this.context.beginPath();
    this.context.arc(x, y, radius, 0, 2 * Math.PI);
  }

  private text(text: string, x: number, y: number, size_m: number, colour: string): void {
    const { context } = this;
    context.save();
    context.translate(x, y);
    context.scale(0.01, -0.01);
    context.font = `700 ${100 * size_m}px system-ui, sans-serif`;
    context.textAlign = "center";
    context.textBaseline = "middle";
    context.fillStyle = colour;
    context.fillText(text, 0, 0);
    context.restore();
  }
}
