/** A robot's links from straight above, for a robot that is looked at from near without WebGL. */

import type { SceneGeom } from "../core/wire";
import type { FloorMarks } from "./marks";
import type { Model } from "./model";
import { css, LIT, luma, mix, type Rgb, rgb } from "./palette";

type Three = readonly [number, number, number];

const EDGE = "rgb(8 12 18 / 85%)";
const EDGE_M = 0.004;
/** What is higher is lighter: seen from above nothing else says how high a link is. */
const HIGH_M = 0.12;

/** Draw all robots; the context is in metres, y up. */
export function drawLinks(
  context: CanvasRenderingContext2D,
  model: Model,
  lit: ReadonlyMap<number, number>,
): void {
  const { scene, fk, sheet } = model;
  const parts = scene.geoms
    .filter((geom) => fk.seats[geom.body]! >= 0 && geom.type !== "plane")
    .map((geom) => ({ geom, at: placed(model, geom, [0, 0, 0]) }))
    .toSorted((one, other) => one.at[2] - other.at[2]);
  context.lineCap = "round";
  context.lineJoin = "round";
  for (const { geom, at } of parts) {
    const seat = sheet.seats[geom.seat];
    const own: Rgb = seat ? rgb(seat.colour) : (geom.rgba.slice(0, 3) as unknown as Rgb);
    const high = Math.min(1, Math.max(0, at[2] / HIGH_M));
    const colour = mix(mix(own, [1, 1, 1], 0.35 * high), LIT, lit.get(geom.body) ?? 0);
    context.beginPath();
    if (geom.type === "box") box(context, model, geom);
    else segment(context, model, geom);
    const width = geom.type === "box" ? 0 : 2 * geom.size[0];
    context.strokeStyle = EDGE;
    context.lineWidth = width + EDGE_M;
    context.stroke();
    context.strokeStyle = context.fillStyle = css(colour);
    if (geom.type === "box") {
      context.fill();
      front(context, model, geom, luma(colour) > 0.5);
    } else {
      context.lineWidth = width;
      context.stroke();
    }
  }
}

/** Draw what `FloorMarks` has, under the robots. */
export function drawMarks(context: CanvasRenderingContext2D, marks: FloorMarks): void {
  const { polygon, isStable, centre, way } = marks;
  context.beginPath();
  for (let at = 0; at + 1 < way.length; at += 2) context.lineTo(way[at]!, way[at + 1]!);
  context.lineWidth = 0.003;
  context.strokeStyle = "rgb(143 180 255 / 60%)";
  context.stroke();
  context.beginPath();
  for (const [x, y] of polygon) context.lineTo(x, y);
  context.closePath();
  context.fillStyle = isStable ? "rgb(77 217 153 / 30%)" : "rgb(255 128 102 / 35%)";
  context.strokeStyle = isStable ? "#6ff0b2" : "#ff9480";
  context.fill();
  context.stroke();
  if (!centre) return;
  context.beginPath();
  context.arc(centre[0], centre[1], 0.006, 0, 2 * Math.PI);
  context.fillStyle = "#fff";
  context.fill();
}

function segment(context: CanvasRenderingContext2D, model: Model, geom: SceneGeom): void {
  const half = geom.type === "sphere" ? 0 : geom.size[1];
  const [ax, ay] = placed(model, geom, [0, 0, -half]);
  const [bx, by] = placed(model, geom, [0, 0, half]);
  context.moveTo(ax, ay);
  context.lineTo(bx, by + 1e-6); // a line of no length has no round ends
}

function box(context: CanvasRenderingContext2D, model: Model, geom: SceneGeom): void {
  const [x, y, z] = geom.size;
  for (const [a, b] of [
    [-1, -1],
    [1, -1],
    [1, 1],
    [-1, 1],
  ] as const) {
    const corner = placed(model, geom, [a * x, b * y, z]);
    context.lineTo(corner[0], corner[1]);
  }
  context.closePath();
}

/** Two eyes, where the robot looks. */
function front(
  context: CanvasRenderingContext2D,
  model: Model,
  geom: SceneGeom,
  isLight: boolean,
): void {
  const [x, y, z] = geom.size;
  context.fillStyle = isLight ? "#10141b" : "#f4f7fb";
  for (const side of [-1, 1]) {
    const [ex, ey] = placed(model, geom, [0.45 * side * x, 0.8 * y, z]);
    context.beginPath();
    context.arc(ex, ey, 0.1 * x, 0, 2 * Math.PI);
    context.fill();
  }
}

/** A point of a geom in the world [m]. */
function placed({ fk }: Model, geom: SceneGeom, point: Three): [number, number, number] {
  const own = turned(geom.quat, point);
  const [bx, by, bz] = geom.pos;
  const quat = fk.quat.subarray(4 * geom.body, 4 * geom.body + 4);
  const [x, y, z] = turned(quat, [bx + own[0], by + own[1], bz + own[2]]);
  const at = 3 * geom.body;
  return [fk.pos[at]! + x, fk.pos[at + 1]! + y, fk.pos[at + 2]! + z];
}

/** Turn a vector by a quaternion w, x, y, z. */
function turned(quat: ArrayLike<number>, [a, b, c]: Three): [number, number, number] {
  const [w, x, y, z] = [quat[0]!, quat[1]!, quat[2]!, quat[3]!];
  const tx = 2 * (y * c - z * b);
  const ty = 2 * (z * a - x * c);
  const tz = 2 * (x * b - y * a);
  return [a + w * tx + y * tz - z * ty, b + w * ty + z * tx - x * tz, c + w * tz + x * ty - y * tx];
}
