/** The shapes that a scene is drawn with: its own geoms in the colours of a hall, and details. */

import { Matrix4, Quaternion, Vector3 } from "three";
import type { SceneGeom } from "../core/wire";
import type { MarkerMotion } from "./markers";
import type { Model } from "./model";
import {
  evening,
  isSame,
  markerColour,
  PATTERNS,
  patternOf,
  type Rgb,
  rgb,
  teamGeoms,
} from "./palette";
import { type Shape, shapeOf } from "./shapes";

/** One shape of the scene. */
export interface Piece {
  body: number;
  shape: Shape;
  /** In the body's frame, stretched. */
  local: Matrix4;
  colour: Rgb;
  pattern: number;
  period_m: number;
  marker: number;
  state: number;
  /** Goes when its marker begins to fall. */
  stays?: boolean;
}

type Size = [number, number, number];

const JOINT: Rgb = [0.13, 0.15, 0.18];
/** Stays as it is, whatever becomes of the robot. */
export const EYE: Rgb = [0.96, 0.98, 1];
const PLATE_PART = 0.62;
const ROBOT_PERIOD_M = 0.03;
const DISC_PERIOD_M = 0.048;
const CLOTH_PERIOD_M = 0.026;
const CLOTH_EDGE_M = 0.005;
const FOOT_M = 0.032;
const FOOT_TOP_M = 0.0012;

/** All shapes of a model but its planes, by how they move. */
export function piecesOf(
  model: Model,
  motion: MarkerMotion,
): Record<"still" | "markers" | "robots", Piece[]> {
  const { scene, sheet, fk } = model;
  const found = { still: [] as Piece[], markers: [] as Piece[], robots: [] as Piece[] };
  const teams = teamGeoms(scene, sheet);
  scene.geoms.forEach((geom, index) => {
    const isRobot = fk.seats[geom.body]! >= 0;
    const shape = geom.type === "plane" ? null : shapeOf(geom, isRobot);
    if (!shape) return;
    const kind = geom.marker >= 0 ? "markers" : isRobot ? "robots" : "still";
    found[kind].push(pieceOf(model, motion, geom, shape, teams[index]!));
  });
  found.robots.push(...detailsOf(model));
  found.markers.push(...feetOf(model, found.markers));
  return found;
}

function pieceOf(
  { scene, sheet, fk }: Model,
  motion: MarkerMotion,
  geom: SceneGeom,
  shape: Shape,
  team: number,
): Piece {
  const own = geom.rgba.slice(0, 3) as unknown as Rgb;
  const seat = sheet.seats[team];
  const tall = geom.marker >= 0 && motion.isTall(geom.marker);
  let colour = evening(own);
  let pattern: number = PATTERNS.plain;
  let period_m = DISC_PERIOD_M;
  if (seat) {
    colour = rgb(seat.colour);
    pattern = patternOf(seat.pattern);
    period_m = geom.marker < 0 ? ROBOT_PERIOD_M : tall ? CLOTH_PERIOD_M : DISC_PERIOD_M;
    // Legs are too thin for a pattern: the body has it.
    if (geom.marker < 0 && geom.type !== "box") pattern = PATTERNS.plain;
  } else if (geom.marker >= 0) {
    const pole = tall && isSame(scene, geom);
    colour = pole ? evening(own) : markerColour(geom.state, own, tall);
    if (tall && !pole && geom.type === "box" && geom.state === 0) {
      pattern = PATTERNS.edge;
      period_m = CLOTH_EDGE_M;
    }
  } else if (fk.seats[geom.body]! >= 0) colour = own;
  const local = new Matrix4().compose(
    new Vector3(...geom.pos),
    new Quaternion(geom.quat[1], geom.quat[2], geom.quat[3], geom.quat[0]),
    new Vector3(...shape.scale),
  );
  return {
    body: geom.body,
    shape,
    local,
    colour,
    pattern,
    period_m,
    marker: geom.marker,
    state: geom.state,
  };
}

/** Details that make boxes and rods look like a robot: a lid, eyes in front, dark joints. */
function detailsOf({ scene }: Model): Piece[] {
  const found: Piece[] = [];
  const add = (body: number, type: string, size: Size, pos: Size, colour: Rgb) => {
    const shape = shapeOf({ type, size }, true)!;
    const local = new Matrix4().makeTranslation(...pos);
    local.scale(new Vector3(...shape.scale));
    const plain = { pattern: 0, period_m: 1, marker: -1, state: -1 };
    found.push({ body, shape, local, colour, ...plain });
  };
  scene.bodies.forEach((body, index) => {
    const mine = scene.geoms.filter((geom) => geom.body === index);
    const box = mine.find((geom) => geom.type === "box");
    if (body.seat >= 0 && box) {
      const [x, y, z] = box.size;
      const low = Math.min(x, y);
      add(index, "box", [PLATE_PART * x, PLATE_PART * y, 0.004], [0, -0.06 * y, z + 0.001], JOINT);
      for (const side of [-1, 1]) {
        add(index, "sphere", [0.2 * low, 0, 0], [side * 0.46 * x, y - 0.002, 0.3 * z], JOINT);
        add(index, "sphere", [0.14 * low, 0, 0], [side * 0.46 * x, y + 0.004, 0.34 * z], EYE);
      }
    }
    const rod = mine.find((geom) => geom.type === "capsule");
    if (body.joint >= 0 && rod) {
      add(index, "sphere", [1.14 * rod.size[0], 0, 0], [0, 0, 0], JOINT);
    }
  });
  return found;
}

/** A coloured spot round the foot of an upright shape, to make it visible from above. */
function feetOf({ sheet }: Model, markers: readonly Piece[]): Piece[] {
  return markers
    .filter(({ pattern }) => pattern === PATTERNS.edge)
    .map((cloth) => {
      const { x_m, y_m } = sheet.markers[cloth.marker]!;
      const shape = shapeOf({ type: "cylinder", size: [FOOT_M, FOOT_TOP_M, 0] }, false)!;
      const local = new Matrix4().makeTranslation(x_m, y_m, FOOT_TOP_M);
      local.scale(new Vector3(...shape.scale));
      return { ...cloth, shape, local, pattern: PATTERNS.plain, stays: true };
    });
}
