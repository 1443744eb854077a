/** Feet that stand, seen from above: the polygon between them, and whether the middle is inside. */

export type Flat = readonly [number, number];

/** The corners of the polygon around all points, counter-clockwise; fewer than three: no area. */
export function hull(places: readonly Flat[]): Flat[] {
  const sorted = [...places].sort((one, other) => one[0] - other[0] || one[1] - other[1]);
  const half = (from: readonly Flat[]) => {
    const made: Flat[] = [];
    for (const place of from) {
      while (made.length > 1 && cross(made.at(-2)!, made.at(-1)!, place) <= 0) made.pop();
      made.push(place);
    }
    return made.slice(0, -1);
  };
  return [...half(sorted), ...half(sorted.reverse())];
}

/** Distance of a point from the nearest edge of the polygon, negative outside; null: no polygon. */
export function margin(places: readonly Flat[], of: Flat = [0, 0]): number | null {
  const corners = hull(places);
  if (corners.length < 3) return null;
  const edges = corners.map((from, index) => [from, corners[(index + 1) % corners.length]!]);
  const inside = Math.min(
    ...edges.map(([from, to]) => cross(from!, to!, of) / Math.hypot(...minus(to!, from!))),
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

/** Positive if the way from `a` over `b` to `c` turns left. */
function cross(a: Flat, b: Flat, c: Flat): number {
  const [x, y] = minus(b, a);
  const [u, v] = minus(c, a);
  return x * v - y * u;
}
