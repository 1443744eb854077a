/** Layers for graphics cards: instances, one draw call for each geometry. */

import {
  type BufferGeometry,
  DynamicDrawUsage,
  InstancedBufferAttribute,
  InstancedMesh,
  type Material,
  type Matrix4,
  type Object3D,
} from "three";
import type { Layer, Paint } from "./layer";
import { type Finish, instanced, type Pair } from "./materials";
import { PATTERNS, partnerIn, type Rgb } from "./palette";
import type { Shape } from "./shapes";

/** Instances of one geometry with one material. */
class Batch {
  readonly mesh: InstancedMesh;
  private readonly matrices: Float32Array;
  private readonly colours: Float32Array;
  private readonly patterns: Float32Array;
  private readonly partners: Float32Array;
  private readonly last: { colour: Rgb; pattern: number }[] = [];
  private tinted = false;
  private count = 0;

  constructor(geometry: BufferGeometry, material: Material, most: number) {
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

  add(matrix: Matrix4, { colour, pattern, period_m }: Paint): void {
    const at = this.count++;
    this.matrices.set(matrix.elements, 16 * at);
    // Colours change seldom: a place that keeps its own is not sent to the graphics card again.
    if (this.last[at]?.colour === colour && this.last[at].pattern === pattern) return;
    this.last[at] = { colour, pattern };
    this.tinted = true;
    const other = partnerIn(colour, pattern);
    for (let part = 0; part < 3; part++) {
      this.colours[3 * at + part] = linear(colour[part]!);
      this.partners[3 * at + part] = linear(other[part]!);
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

/** From a screen's value to the amount of light. */
function linear(value: number): number {
  return value <= 0.04045 ? value / 12.92 : ((value + 0.055) / 1.055) ** 2.4;
}

/** Draws on a graphics card, in full light and with shadows. */
export class InstancedLayer implements Layer {
  private readonly batches = new Map<string, Batch>();
  private readonly materials: Pair;

  constructor(
    private readonly parent: Object3D,
    finish: Finish,
    private readonly order: number,
    private readonly opacity = 1,
  ) {
    this.materials = instanced(finish);
    if (opacity === 1) return;
    for (const material of Object.values(this.materials) as Material[]) {
      Object.assign(material, { transparent: true, opacity });
    }
  }

  reserve(shape: Shape, pattern: number, most: number): void {
    const { plain, patterned } = this.materials;
    const batch = new Batch(shape.make(true), pattern ? patterned : plain, most);
    batch.mesh.castShadow = batch.mesh.receiveShadow = this.opacity === 1;
    batch.mesh.renderOrder = this.order;
    this.batches.set(batchKey(shape, pattern), batch);
    this.parent.add(batch.mesh);
  }

  add(shape: Shape, matrix: Matrix4, paint: Paint): void {
    this.batches.get(batchKey(shape, paint.pattern))!.add(matrix, paint);
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
function batchKey(shape: Shape, pattern: number): string {
  return pattern === PATTERNS.plain ? shape.key : `${shape.key} pattern`;
}
