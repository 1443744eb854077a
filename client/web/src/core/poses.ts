/** Where the robots of a frame are. */

import { type Frame, ROOT_FLOATS, type Scene, type Sheet } from "./wire";

/** A robot seen from above, in the world's frame. */
export interface Place {
  xM: number;
  yM: number;
  /** 0 along the world's x, counter-clockwise; the robot's front is its body's +y. */
  headingRad: number;
}

/** The floor between the walls, in the world's frame. */
export interface Floor {
  xM: number;
  yM: number;
  halfXM: number;
  halfYM: number;
}

const MARGIN_M = 0.15;

/** The numbers of a frame's poses; they may lie at any byte of a message. */
export function floats(bytes: Uint8Array): Float32Array {
  return new Float32Array(bytes.slice().buffer);
}

/** Each seat's robot; [] before the robots stand. */
export function places(frame: Frame, sheet: Sheet): Place[] {
  const numbers = floats(frame.poses);
  const found: Place[] = [];
  let at = 0;
  for (const seat of sheet.seats) {
    if (at + ROOT_FLOATS > numbers.length) break;
    const [x, y, , qw, qx, qy, qz] = numbers.subarray(at, at + ROOT_FLOATS) as unknown as number[];
    const frontX = 2 * (qx! * qy! - qw! * qz!);
    const frontY = 1 - 2 * (qx! * qx! + qz! * qz!);
    found.push({ xM: x!, yM: y!, headingRad: Math.atan2(frontY, frontX) });
    at += ROOT_FLOATS + 3 * seat.legs.length;
  }
  return found;
}

/** The floor of a scene, or what is around the markers if it has none. */
export function floorOf(scene: Scene | null, sheet: Sheet): Floor {
  const plane = scene?.geoms.find((geom) => geom.type === "plane" && geom.size[0] > 0);
  if (plane) {
    return { xM: plane.pos[0], yM: plane.pos[1], halfXM: plane.size[0], halfYM: plane.size[1] };
  }
  const reach = (of: (marker: Sheet["markers"][number]) => number) =>
    Math.max(1, ...sheet.markers.map((marker) => Math.abs(of(marker)) + marker.radius_m)) +
    MARGIN_M;
  return { xM: 0, yM: 0, halfXM: reach((m) => m.x_m), halfYM: reach((m) => m.y_m) };
}
