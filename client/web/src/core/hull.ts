/** The convex hull of points in a plane. */

export type Flat = readonly [number, number];

/** The corners of the convex hull, counter-clockwise; one or two if there are no more. */
export function hull(points: readonly Flat[]): Flat[] {
  const ordered = points
    .toSorted((one, other) => one[0] - other[0] || one[1] - other[1])
    .filter(([x, y], index, all) => x !== all[index - 1]?.[0] || y !== all[index - 1]?.[1]);
  if (ordered.length < 3) return ordered;
  return [ordered, ordered.toReversed()].flatMap((way) => {
    const half: Flat[] = [];
    for (const point of way) {
      while (half.length > 1 && leftOf(half.at(-2)!, half.at(-1)!, point) <= 0) half.pop();
      half.push(point);
    }
    return half.slice(0, -1);
  });
}

/** Twice the area of a triangle; positive if the point is left of the line. */
export function leftOf(start: Flat, end: Flat, point: Flat): number {
  const [x, y] = [end[0] - start[0], end[1] - start[1]];
  return x * (point[1] - start[1]) - y * (point[0] - start[0]);
}
