/** Tools for whole rows and legs: mirror, other half, copy of a leg, and the seam of a sequence. */

import { SEAM_DEG, SEAM_RATIO } from "../wire";
import { type Cell, joint, LEVELS, mapRows, type Row, type Table, withCells } from "./table";

/** A row that is the mirror of another one; rows as indices. */
export interface Half {
  readonly from: number;
  readonly to: number;
}

/** What a joint does where a sequence begins again. */
export interface Seam {
  /** How far it turns from the last posture to the first [deg]; NaN without an angle. */
  stepDeg: number;
  /** The largest of its other steps [deg]. */
  otherDeg: number;
  /** Whether that is a jump, as `lacoc trial` says it (docs/studio.md 3). */
  jumps: boolean;
}

/** The leg on the other side: legs are numbered clockwise from the right front (rules 1). */
export const mirrorLeg = (leg: number, legs: number) => legs - 1 - leg;

/**
 * The cells of the posture as a mirror between left and right shows it. No angle changes its sign:
 * a positive root angle swings a leg forward on both sides (workshop 3-1).
 */
export function mirrored(cells: readonly Cell[], legs: number): Cell[] {
  return cells.map((_, id) => {
    const level = Math.floor(id / legs);
    return cells[joint(mirrorLeg(id % legs, legs), level, legs)]!;
  });
}

/** Mirror rows in their places. */
export function mirrorRows(table: Table, rows: readonly number[]): Table {
  return mapRows(table, (row, index) => (rows.includes(index) ? mirrorOf(table, row, row) : row));
}

/** The second half of a sequence as mirrors of its first; [] if there is no such half. */
export function halvesOf(sequence: readonly number[]): Half[] {
  const half = sequence.length / 2;
  if (!Number.isInteger(half) || new Set(sequence).size < sequence.length) return [];
  return sequence.slice(0, half).map((from, index) => ({ from, to: sequence[half + index]! }));
}

/** Make the second half of a sequence the mirror of its first. */
export function otherHalf(table: Table, halves: readonly Half[]): Table {
  const sources = new Map(halves.map(({ from, to }) => [to, from]));
  return mapRows(table, (row, index) => {
    const from = table.rows[sources.get(index) ?? -1];
    return from ? mirrorOf(table, row, from) : row;
  });
}

/**
 * Keep halves each other's mirror after an edit: what changed in one changes in the other.
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

/** Give a leg the angles of another one, in some rows. */
export function copyLeg(table: Table, rows: readonly number[], from: number, to: number): Table {
  const legs = table.legs.length;
  return mapRows(table, (row, index) => {
    if (!rows.includes(index)) return row;
    return withCells(row, (cell, id) =>
      id % legs === to ? row.cells[joint(from, Math.floor(id / legs), legs)]! : cell,
    );
  });
}

/** The seam of a sequence, by joint id; [] if the sequence has fewer than two postures. */
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
