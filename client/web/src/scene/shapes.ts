/**
 * Geometry: MuJoCo's shapes in three's terms.
 *
 * Without a graphics card a triangle costs nearly 1 us, however small it is: coarse shapes have as
 * few as look round.
 */

import {
  BoxGeometry,
  BufferGeometry,
  CapsuleGeometry,
  CylinderGeometry,
  Float32BufferAttribute,
  SphereGeometry,
} from "three";
import type { SceneGeom } from "../core/wire";

/** A geometry that several geoms can share, and how much each stretches it. */
export interface Shape {
  key: string;
  scale: [number, number, number];
  make(fine: boolean): BufferGeometry;
}

const FLAT_M = 0.003;
const PLATE_CORNERS = 24;
/** A robot's boxes have rounded edges, which reflect the light. */
const ROUND_M = 0.012;

/** The shape of a geom; sizes are MuJoCo's half sizes, z is up. */
export function shapeOf(geom: Pick<SceneGeom, "type" | "size">, round: boolean): Shape | null {
  const [a, b, c] = geom.size;
  switch (geom.type) {
    case "sphere":
      return { key: "sphere", scale: [a, a, a], make: sphere };
    case "ellipsoid":
      return { key: "sphere", scale: [a, b, c], make: sphere };
    case "cylinder":
      if (b < FLAT_M) return { key: "plate", scale: [a, a, b], make: plate };
      return { key: `cylinder${a < 0.03}`, scale: [a, a, b], make: (fine) => cylinder(fine, a) };
    case "capsule":
      return {
        key: `capsule ${a} ${b}`,
        scale: [1, 1, 1],
        make: (fine) =>
          new CapsuleGeometry(a, 2 * b, fine ? 8 : 2, fine ? 20 : 6).rotateX(Math.PI / 2),
      };
    case "box":
      if (!round) return { key: "box", scale: [a, b, c], make: () => new BoxGeometry(2, 2, 2) };
      return {
        key: `round ${a} ${b} ${c}`,
        scale: [1, 1, 1],
        make: (fine) => roundedBox(a, b, c, fine ? 5 : 1),
      };
    default:
      return null;
  }
}

function sphere(fine: boolean): BufferGeometry {
  return fine ? new SphereGeometry(1, 24, 16) : new SphereGeometry(1, 8, 4);
}

function cylinder(fine: boolean, radius: number): BufferGeometry {
  const segments = radius < 0.03 ? (fine ? 16 : 8) : fine ? 72 : 36;
  return new CylinderGeometry(1, 1, 2, segments).rotateX(Math.PI / 2);
}

/** A cylinder so flat that, drawn coarsely, its side is not missed. */
function plate(fine: boolean): BufferGeometry {
  if (fine) return cylinder(fine, 1);
  const index: number[] = [];
  const position: number[] = [];
  const normal: number[] = [];
  for (const side of [1, -1]) {
    const first = position.length / 3;
    for (let corner = 0; corner < PLATE_CORNERS; corner++) {
      const turn = (corner / PLATE_CORNERS) * 2 * Math.PI;
      position.push(Math.cos(turn), Math.sin(turn), side);
      normal.push(0, 0, side);
      if (corner < 2) continue;
      const [one, other] = side > 0 ? [corner - 1, corner] : [corner, corner - 1];
      index.push(first, first + one, first + other);
    }
  }
  const geometry = new BufferGeometry();
  geometry.setIndex(index);
  geometry.setAttribute("position", new Float32BufferAttribute(position, 3));
  geometry.setAttribute("normal", new Float32BufferAttribute(normal, 3));
  return geometry;
}

/** A box whose edges are rounded: a finer box, its surface drawn to the inner box and blown up. */
function roundedBox(x: number, y: number, z: number, steps: number): BufferGeometry {
  const radius = Math.min(ROUND_M, 0.6 * Math.min(x, y, z));
  const cuts = 2 * steps + 1;
  const geometry = new BoxGeometry(2, 2, 2, cuts, cuts, cuts);
  const half = [x, y, z] as const;
  const position = geometry.getAttribute("position");
  const normal = geometry.getAttribute("normal");
  for (let vertex = 0; vertex < position.count; vertex++) {
    const inner: number[] = [];
    const out: number[] = [];
    for (let axis = 0; axis < 3; axis++) {
      // The outer cuts share the corner's quarter circle, the middle one spans the flat.
      const at = Math.round(((position.getComponent(vertex, axis) + 1) / 2) * cuts);
      const corner = half[axis]! - radius;
      inner.push(at <= steps ? -corner : corner);
      const turn = at <= steps ? at / steps - 1 : (at - steps - 1) / steps;
      out.push(Math.tan((turn * Math.PI) / 4));
    }
    const length = Math.hypot(out[0]!, out[1]!, out[2]!) || 1;
    for (let axis = 0; axis < 3; axis++) {
      normal.setComponent(vertex, axis, out[axis]! / length);
      position.setComponent(vertex, axis, inner[axis]! + (out[axis]! / length) * radius);
    }
  }
  return geometry;
}
