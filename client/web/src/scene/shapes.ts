/** Geometry: MuJoCo's shapes in three's terms, drawn in batches of one draw call each. */

import {
  BoxGeometry,
  BufferGeometry,
  CapsuleGeometry,
  CylinderGeometry,
  DynamicDrawUsage,
  Float32BufferAttribute,
  InstancedBufferAttribute,
  InstancedMesh,
  type Material,
  type Matrix4,
  type Object3D,
  SphereGeometry,
} from "three";
import type { SceneGeom } from "../core/wire";
import type { Pair } from "./materials";
import { PATTERNS, partner, type Rgb } from "./palette";

/** A geometry that several geoms can share, and how much each stretches it. */
export interface Shape {
  key: string;
  scale: [number, number, number];
  make(fine: boolean): BufferGeometry;
}

const FLAT_M = 0.003;
const PLATE_CORNERS = 30;
/** Of a robot's boxes: rounded, so that the light plays on them. */
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
          new CapsuleGeometry(a, 2 * b, fine ? 8 : 3, fine ? 20 : 8).rotateX(Math.PI / 2),
      };
    case "box":
      if (!round) return { key: "box", scale: [a, b, c], make: () => new BoxGeometry(2, 2, 2) };
      return {
        key: `round ${a} ${b} ${c}`,
        scale: [1, 1, 1],
        make: (fine) => roundedBox(a, b, c, fine ? 5 : 2),
      };
    default:
      return null;
  }
}

function sphere(fine: boolean): BufferGeometry {
  return fine ? new SphereGeometry(1, 24, 16) : new SphereGeometry(1, 10, 6);
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

/** Instances of one geometry with one material; filled anew whenever something changes. */
export class Batch {
  readonly mesh: InstancedMesh;
  private readonly matrices: Float32Array;
  private readonly colours: Float32Array;
  private readonly patterns: Float32Array;
  private readonly partners: Float32Array;
  private readonly last: { colour: Rgb; pattern: number }[] = [];
  private tinted = false;
  private count = 0;

  /** @param raw Colours go to the screen as they are, not through the light's arithmetic. */
  constructor(
    geometry: BufferGeometry,
    material: Material,
    most: number,
    private readonly raw: boolean,
  ) {
    this.mesh = new InstancedMesh(geometry, material, most);
    this.mesh.frustumCulled = false;
    this.matrices = this.mesh.instanceMatrix.array as Float32Array;
    this.colours = new Float32Array(3 * most);
    this.patterns = new Float32Array(2 * most);
    this.partners = new Float32Array(3 * most);
    this.mesh.instanceColor = new InstancedBufferAttribute(this.colours, 3);
    geometry.setAttribute("pattern", new InstancedBufferAttribute(this.patterns, 2));
    geometry.setAttribute("patternColour", new InstancedBufferAttribute(this.partners, 3));
    for (const attribute of this.attributes) attribute.setUsage(DynamicDrawUsage);
  }

  private get attributes(): InstancedBufferAttribute[] {
    const { attributes } = this.mesh.geometry;
    return [
      this.mesh.instanceMatrix,
      this.mesh.instanceColor!,
      attributes.pattern as InstancedBufferAttribute,
      attributes.patternColour as InstancedBufferAttribute,
    ];
  }

  clear(): void {
    this.count = 0;
  }

  add(matrix: Matrix4, colour: Rgb, pattern: number, period_m: number): void {
    const at = this.count++;
    this.matrices.set(matrix.elements, 16 * at);
    // Colours change seldom: a place that keeps its own is not sent to the graphics card again.
    if (this.last[at]?.colour === colour && this.last[at].pattern === pattern) return;
    this.last[at] = { colour, pattern };
    this.tinted = true;
    const other = pattern ? (pattern === PATTERNS.edge ? EDGE : partner(colour)) : colour;
    for (let part = 0; part < 3; part++) {
      this.colours[3 * at + part] = this.raw ? colour[part]! : linear(colour[part]!);
      this.partners[3 * at + part] = this.raw ? other[part]! : linear(other[part]!);
    }
    this.patterns[2 * at] = pattern;
    this.patterns[2 * at + 1] = period_m;
  }

  /** Show what was added since `clear`. */
  done(): void {
    this.mesh.count = this.count;
    this.mesh.visible = this.count > 0;
    this.mesh.instanceMatrix.needsUpdate = true;
    if (this.tinted) for (const attribute of this.attributes) attribute.needsUpdate = true;
    this.tinted = false;
  }

  dispose(): void {
    this.mesh.geometry.dispose();
    this.mesh.dispose();
  }
}

const EDGE: Rgb = [0.93, 0.94, 0.96];

/** From a screen's value to the amount of light. */
export function linear(value: number): number {
  return value <= 0.04045 ? value / 12.92 : ((value + 0.055) / 1.055) ** 2.4;
}

/** The batches of things that change together. */
export class Layer {
  private readonly batches = new Map<string, Batch>();

  constructor(
    private readonly parent: Object3D,
    private readonly materials: Pair,
    private readonly fine: boolean,
    /** What lies on top is drawn first: what it covers is not drawn at all. */
    private readonly order: number,
  ) {}

  /** Make room for `most` instances of a shape. */
  reserve(shape: Shape, pattern: number, most: number): void {
    const { plain, patterned } = this.materials;
    const batch = new Batch(shape.make(this.fine), pattern ? patterned : plain, most, !this.fine);
    batch.mesh.castShadow = this.fine;
    batch.mesh.receiveShadow = this.fine;
    batch.mesh.renderOrder = this.order;
    this.batches.set(batchKey(shape, pattern), batch);
    this.parent.add(batch.mesh);
  }

  of(shape: Shape, pattern: number): Batch {
    return this.batches.get(batchKey(shape, pattern))!;
  }

  clear(): void {
    for (const batch of this.batches.values()) batch.clear();
  }

  done(): void {
    for (const batch of this.batches.values()) batch.done();
  }

  dispose(): void {
    for (const batch of this.batches.values()) {
      batch.mesh.removeFromParent();
      batch.dispose();
    }
    this.batches.clear();
    this.materials.plain.dispose();
    this.materials.patterned.dispose();
  }
}

/** Shapes of one key can share a batch: patterns cost something, so only those who have one pay. */
export function batchKey(shape: Shape, pattern: number): string {
  return pattern === PATTERNS.plain ? shape.key : `${shape.key} pattern`;
}
