/** Tools for whole rows and legs: mirror, other half, copy of a leg, and the seam of a sequence. */

import { SEAM_DEG, SEAM_RATIO } from "../wire";
import { type Cell, joint, LEVELS, mapRows, type Row, type Table, withCells } from "./table";

/** The row `to` is, or becomes, the mirror of the row `from`; both are indices. */
export interface Half {
  readonly from: number;
  readonly to: number;
}

/** The motion of a joint where a sequence begins again. */
export interface Seam {
  /** How far the joint turns from the last posture to the first [deg]; NaN without an angle. */
  stepDeg: number;
  /** The largest other step of the joint in the sequence [deg]. */
  otherDeg: number;
  /** Whether the step at the seam is a jump, by the rule of `lacoc trial` (docs/studio.md 3). */
  jumps: boolean;
}

/** The leg opposite to a leg; legs are numbered clockwise from the right front (rules 1). */
export const mirrorLeg = (leg: number, legs: number) => legs - 1 - leg;

/**
 * The cells of a posture with its left and right side swapped. No angle changes its sign, because a
 * positive root angle swings a leg forward on both sides (workshop 3-1).
 */
export function mirrored(cells: readonly Cell[], legs: number): Cell[] {
  return cells.map((_, id) => {
    const level = Math.floor(id / legs);
    return cells[joint(mirrorLeg(id % legs, legs), level, legs)]!;
  });
}

/** Replace rows by their own mirror. */
export function mirrorRows(table: Table, rows: readonly number[]): Table {
  return mapRows(table, (row, index) => (rows.includes(index) ? mirrorOf(table, row, row) : row));
}

/** Pair each row of a sequence's first half with one of its second half; [] if it has no halves. */
export function halvesOf(sequence: readonly number[]): Half[] {
  const half = sequence.length / 2;
  if (!Number.isInteger(half) || new Set(sequence).size < sequence.length) return [];
  return sequence.slice(0, half).map((from, index) => ({ from, to: sequence[half + index]! }));
}

/** Make each row `to` the mirror of its row `from`. */
export function otherHalf(table: Table, halves: readonly Half[]): Table {
  const sources = new Map(halves.map(({ from, to }) => [to, from]));
  return mapRows(table, (row, index) => {
    const from = table.rows[sources.get(index) ?? -1];
    return from ? mirrorOf(table, row, from) : row;
  });
}

/**
 * After an edit of a row, make its partner in the other half its mirror again.
 *
 * @param before The table before the edit, with as many rows.
 * @param after The table after it.
 */
export function follow(before: Table, after: Table, halves: readonly Half[]): Table {
  const ways = halves.map(({ from, to }) => {
    const isBackward = before.rows[from] === after.rows[from] && before.rows[to] !== after.rows[to];
    return isBackward ? { from: to, to: from } : { from, to };
  });
  return otherHalf(after, ways);
}

/** Give the leg `to` the angles of the leg `from`, in some rows. */
export function copyLeg(table: Table, rows: readonly number[], from: number, to: number): Table {
  const legs = table.legs.length;
  return mapRows(table, (row, index) => {
    if (!rows.includes(index)) return row;
    return withCells(row, (cell, id) =>
      id % legs === to ? row.cells[joint(from, Math.floor(id / legs), legs)]! : cell,
    );
  });
}

/** The seam of each joint, by joint id; [] if the sequence has fewer than two postures. */
export function seam(table: Table, sequence: readonly number[]): Seam[] {
  const rows = sequence.map((row) => table.rows[row]!.cells);
  const [first, last] = [rows[0], rows.at(-1)];
  if (!first || !last || rows.length < 2) return [];
  const apart = (one: Cell, other: Cell) =>
    typeof one === "number" && typeof other === "number" ? Math.abs(one - other) : Number.NaN;
  return Array.from({ length: table.legs.length * LEVELS.length }, (_, id) => {
    const stepDeg = apart(first[id]!, last[id]!);
    const steps = rows.slice(1).map((cells, index) => apart(cells[id]!, rows[index]![id]!));
    const otherDeg = Math.max(...steps);
    const jumps = stepDeg > Math.max(otherDeg * SEAM_RATIO, otherDeg + SEAM_DEG);
    return { stepDeg, otherDeg, jumps };
  });
}

function mirrorOf(table: Table, row: Row, from: Row): Row {
  const cells = mirrored(from.cells, table.legs.length);
  return withCells(row, (_, id) => cells[id]!);
}
