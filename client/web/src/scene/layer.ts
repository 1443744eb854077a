/** The interface of renderers of shapes that change together. */

import type { Matrix4 } from "three";
import type { Rgb } from "./palette";
import type { Shape } from "./shapes";

/** How one piece is coloured. */
export interface Paint {
  colour: Rgb;
  /** Index into `PATTERNS`. */
  pattern: number;
  period_m: number;
}

/** Pieces that change together: refilled from `clear` to `done` when one of them changes. */
export interface Layer {
  /** Make room for `most` pieces of a shape, with this pattern or another that is not plain. */
  reserve(shape: Shape, pattern: number, most: number): void;
  /** Make the layer empty. */
  clear(): void;
  /** Add a piece; `matrix` takes it to the world. */
  add(shape: Shape, matrix: Matrix4, paint: Paint): void;
  /** Show what was added since `clear`. */
  done(): void;
  dispose(): void;
}

/** Reserve room for all of some pieces. */
export function reserveAll(
  layer: Layer,
  pieces: readonly { shape: Shape; pattern: number }[],
): void {
  const counts = new Map<string, { shape: Shape; pattern: number; most: number }>();
  for (const { shape, pattern } of pieces) {
    const key = `${shape.key} ${pattern > 0}`;
    const known = counts.get(key);
    if (known) known.most++;
    else counts.set(key, { shape, pattern, most: 1 });
  }
  for (const { shape, pattern, most } of counts.values()) layer.reserve(shape, pattern, most);
}
