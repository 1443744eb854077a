/**
 * Layers for machines without a graphics card: a whole layer is one mesh in world coordinates.
 *
 * Drawn by software (SwiftShader), a picture of one mesh costs less processor time than one of 190
 * instances; docs/gateway.md has the figures. Moving and lighting some thousand corners here takes a
 * fraction of a millisecond.
 */

import {
  BufferAttribute,
  BufferGeometry,
  DynamicDrawUsage,
  type Material,
  type Matrix4,
  Mesh,
  type Object3D,
} from "three";
import type { Layer, Paint } from "./layer";
import { baked } from "./materials";
import { partnerIn, type Rgb } from "./palette";
import type { Shape } from "./shapes";

/** A shape's corners as plain arrays. */
interface Form {
  position: ArrayLike<number>;
  normal: ArrayLike<number>;
  index: ArrayLike<number>;
}

/** Draws by software, in a simple light that is worked out at the corners. */
export class BakedLayer implements Layer {
  private readonly forms = new Map<string, Form>();
  private readonly sizes = {
    plain: { corners: 0, indices: 0 },
    patterned: { corners: 0, indices: 0 },
  };
  private plain: Bake | null = null;
  private patterned: Bake | null = null;

  constructor(
    private readonly parent: Object3D,
    private readonly order: number,
    private readonly opacity = 1,
  ) {}

  reserve(shape: Shape, pattern: number, most: number): void {
    const { position, index } = this.form(shape);
    const size = pattern ? this.sizes.patterned : this.sizes.plain;
    size.corners += most * (position.length / 3);
    size.indices += most * index.length;
  }

  clear(): void {
    this.plain?.clear();
    this.patterned?.clear();
  }

  add(shape: Shape, matrix: Matrix4, paint: Paint): void {
    const form = this.form(shape);
    if (paint.pattern) {
      this.patterned ??= this.make(this.sizes.patterned, true);
      this.patterned.add(form, matrix, paint);
    } else {
      this.plain ??= this.make(this.sizes.plain, false);
      this.plain.add(form, matrix, paint);
    }
  }

  done(): void {
    this.plain?.done();
    this.patterned?.done();
  }

  dispose(): void {
    this.plain?.dispose();
    this.patterned?.dispose();
    this.plain = this.patterned = null;
  }

  private make({ corners, indices }: { corners: number; indices: number }, isPatterned: boolean) {
    const bake = new Bake(corners, indices, isPatterned);
    bake.mesh.renderOrder = this.order;
    const { opacity } = this;
    if (opacity < 1) Object.assign(bake.mesh.material, { transparent: true, opacity });
    this.parent.add(bake.mesh);
    return bake;
  }

  private form(shape: Shape): Form {
    const known = this.forms.get(shape.key);
    if (known) return known;
    const geometry = shape.make(false);
    const form = {
      position: geometry.getAttribute("position").array,
      normal: geometry.getAttribute("normal").array,
      index: geometry.getIndex()!.array,
    };
    this.forms.set(shape.key, form);
    return form;
  }
}

/** One mesh of many pieces. */
class Bake {
  readonly mesh: Mesh<BufferGeometry, Material>;
  private readonly position: BufferAttribute;
  private readonly colour: BufferAttribute;
  private readonly index: BufferAttribute;
  /** For patterned pieces: place on the shape [m], its half sizes [m], pattern and partner. */
  private readonly pattern: {
    at: BufferAttribute;
    half: BufferAttribute;
    of: BufferAttribute;
  } | null;
  private readonly partner: BufferAttribute | null;
  /** How bright each corner is. */
  private readonly lights: Float32Array;
  private corners = 0;
  private indices = 0;
  /** Shapes in their order: as long as it is the same, the index need not be sent again. */
  private readonly order: Form[] = [];
  private pieces = 0;
  private isReordered = false;

  constructor(corners: number, indices: number, isPatterned: boolean) {
    const geometry = new BufferGeometry();
    const attribute = (name: string, array: Float32Array | Uint8Array, size: number) => {
      const made = new BufferAttribute(array, size, array instanceof Uint8Array);
      geometry.setAttribute(name, made.setUsage(DynamicDrawUsage));
      return made;
    };
    this.position = attribute("position", new Float32Array(3 * corners), 3);
    this.colour = attribute("color", new Uint8Array(4 * corners).fill(255), 4);
    this.pattern = isPatterned
      ? {
          at: attribute("at", new Float32Array(3 * corners), 3),
          half: attribute("half_m", new Float32Array(3 * corners), 3),
          of: attribute("pattern", new Float32Array(2 * corners), 2),
        }
      : null;
    this.partner = isPatterned ? attribute("patternColour", new Uint8Array(4 * corners), 4) : null;
    this.lights = new Float32Array(corners);
    this.index = new BufferAttribute(new Uint32Array(indices), 1).setUsage(DynamicDrawUsage);
    geometry.setIndex(this.index);
    this.mesh = new Mesh(geometry, baked(isPatterned));
    this.mesh.frustumCulled = false;
  }

  clear(): void {
    this.corners = this.indices = this.pieces = 0;
  }

  add(form: Form, matrix: Matrix4, paint: Paint): void {
    const first = this.corners;
    if (this.order[this.pieces] !== form) {
      this.order[this.pieces] = form;
      this.isReordered = true;
    }
    this.pieces++;
    if (this.isReordered) {
      const index = this.index.array;
      for (let at = 0; at < form.index.length; at++) {
        index[this.indices + at] = first + form.index[at]!;
      }
    }
    this.indices += form.index.length;
    this.corners += form.position.length / 3;
    this.place(form, matrix.elements, first, paint.colour);
    if (this.pattern) this.decorate(form, matrix.elements, first, paint);
  }

  /** Show what was added since `clear`. */
  done(): void {
    const { geometry } = this.mesh;
    geometry.setDrawRange(0, this.indices);
    this.mesh.visible = this.indices > 0;
    for (const attribute of [
      this.position,
      this.colour,
      this.partner,
      ...Object.values(this.pattern ?? {}),
    ]) {
      if (!attribute) continue;
      attribute.clearUpdateRanges();
      attribute.addUpdateRange(0, this.corners * attribute.itemSize);
      attribute.needsUpdate = true;
    }
    if (this.isReordered) this.index.needsUpdate = true;
    this.isReordered = false;
    // Entries of the index after the last piece are no longer valid.
    this.order.length = this.pieces;
  }

  dispose(): void {
    this.mesh.removeFromParent();
    this.mesh.geometry.dispose();
    this.mesh.material.dispose();
  }

  /** Write the corners of a piece: where they are, and their colour in the light. */
  private place(
    { position, normal }: Form,
    m: ArrayLike<number>,
    first: number,
    colour: Rgb,
  ): void {
    const places = this.position.array;
    const colours = this.colour.array;
    const { lights } = this;
    const [red, green, blue] = colour;
    // A normal is turned as its surface, whatever stretches it.
    const sx = 1 / (m[0]! * m[0]! + m[1]! * m[1]! + m[2]! * m[2]! || 1);
    const sy = 1 / (m[4]! * m[4]! + m[5]! * m[5]! + m[6]! * m[6]! || 1);
    const sz = 1 / (m[8]! * m[8]! + m[9]! * m[9]! + m[10]! * m[10]! || 1);
    for (
      let at = 0, to = 3 * first, tint = 4 * first;
      at < position.length;
      at += 3, to += 3, tint += 4
    ) {
      const x = position[at]!;
      const y = position[at + 1]!;
      const z = position[at + 2]!;
      places[to] = m[0]! * x + m[4]! * y + m[8]! * z + m[12]!;
      places[to + 1] = m[1]! * x + m[5]! * y + m[9]! * z + m[13]!;
      places[to + 2] = m[2]! * x + m[6]! * y + m[10]! * z + m[14]!;
      const nx = normal[at]! * sx;
      const ny = normal[at + 1]! * sy;
      const nz = normal[at + 2]! * sz;
      const outX = m[0]! * nx + m[4]! * ny + m[8]! * nz;
      const outY = m[1]! * nx + m[5]! * ny + m[9]! * nz;
      const outZ = m[2]! * nx + m[6]! * ny + m[10]! * nz;
      // Bright from above, a little from the side.
      const length = Math.sqrt(outX * outX + outY * outY + outZ * outZ) || 1;
      const side = Math.max(0, -0.4 * outX - 0.32 * outY + 0.86 * outZ);
      const light = 255 * (0.52 + (0.26 * (outZ + side)) / length);
      lights[tint >> 2] = light;
      colours[tint] = Math.min(255, red * light);
      colours[tint + 1] = Math.min(255, green * light);
      colours[tint + 2] = Math.min(255, blue * light);
    }
  }

  /** Write what the pattern of a piece needs; `place` has written its light. */
  private decorate(form: Form, m: ArrayLike<number>, first: number, paint: Paint): void {
    const { at: ats, half, of } = this.pattern!;
    const { position } = form;
    const { colour, pattern, period_m } = paint;
    const partner = partnerIn(colour, pattern);
    const scale = [0, 4, 8].map((column) => Math.hypot(m[column]!, m[column + 1]!, m[column + 2]!));
    for (let corner = 0; corner < position.length / 3; corner++) {
      const to = first + corner;
      for (let axis = 0; axis < 3; axis++) {
        ats.array[3 * to + axis] = position[3 * corner + axis]! * scale[axis]!;
        half.array[3 * to + axis] = scale[axis]!;
        this.partner!.array[4 * to + axis] = Math.min(255, partner[axis]! * this.lights[to]!);
      }
      of.array[2 * to] = pattern;
      of.array[2 * to + 1] = period_m;
    }
  }
}
