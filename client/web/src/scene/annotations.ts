/** What a page writes over the picture: it is told with each picture where points of the world are. */

import type { Placing } from "./tags";

/** A place in the picture: x, y [px], and how far it is from the camera [m]. */
export type Placed = NonNullable<ReturnType<Placing>>;

/**
 * The point of the world [m] at a place in the picture.
 *
 * @param z Its height [m]; used where the picture is a map, which has no depth.
 */
export type Reaching = (at: Placed, z: number) => [number, number, number];

export interface Annotations {
  /** True while something is dragged: the camera, which may follow it, stands still. */
  readonly isHeld: boolean;
  /**
   * Follow the picture that was just drawn.
   *
   * @param place Where points are in it.
   * @param reach The way back, with the camera as it is when it is asked for.
   */
  draw(place: Placing, reach: () => Reaching | null): void;
}
