/** Feet that stand, seen from above: how far the middle is inside the polygon between them. */

import { type Flat, hull, leftOf } from "../hull";

/** Distance of a point from the nearest edge of the polygon, negative outside; null: no polygon. */
export function margin(places: readonly Flat[], of: Flat = [0, 0]): number | null {
  const corners = hull(places);
  if (corners.length < 3) return null;
  const edges = corners.map((from, index) => [from, corners[(index + 1) % corners.length]!]);
  const inside = Math.min(
    ...edges.map(([from, to]) => leftOf(from!, to!, of) / Math.hypot(...minus(to!, from!))),
  );
  if (inside >= 0) return inside;
  return -Math.min(...edges.map(([from, to]) => distance(of, from!, to!)));
}

/** Distance of a point from a segment. */
function distance(of: Flat, from: Flat, to: Flat): number {
  const [x, y] = minus(to, from);
  const [u, v] = minus(of, from);
  const part = Math.min(1, Math.max(0, (u * x + v * y) / (x * x + y * y)));
  return Math.hypot(u - part * x, v - part * y);
}

function minus(one: Flat, other: Flat): Flat {
  return [one[0] - other[0], one[1] - other[1]];
}
