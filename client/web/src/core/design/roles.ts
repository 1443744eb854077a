/** Who designs which rows in a group, and what becomes a proposal (workshop 4-2). */

import type { GroupMember } from "../wire";
import { type Cell, mapRows, type Row, type Table, withCells } from "./table";

export const ROLES = ["forward", "turn"] as const;

/** The rows of each role, by their digits: "Forward [1-4] and Right-turn [5-8]". */
const ROWS: Readonly<Record<string, readonly number[]>> = {
  forward: [1, 2, 3, 4],
  turn: [5, 6, 7, 8],
};

/** A change of a number in a row that somebody else owns. */
export interface Proposed {
  row: Row;
  col: number;
  cell: Cell;
}

/** The members who own a row; none: everybody may change it. */
export function ownersOf(
  { kind }: Pick<Table, "kind">,
  { key }: Pick<Row, "key">,
  members: readonly GroupMember[],
): GroupMember[] {
  if (kind !== "postures") return [];
  return members.filter(({ role }) => ROWS[role]?.includes(key));
}

/**
 * An edit without its changes of rows that others own.
 *
 * @param isForeign Whether somebody else owns a row.
 */
export function guarded(
  before: Table,
  after: Table,
  isForeign: (row: Row) => boolean,
): { table: Table; proposed: Proposed[] } {
  const proposed: Proposed[] = [];
  if (before.kind !== after.kind || before.legs.length !== after.legs.length) {
    return { table: after, proposed };
  }
  const old = new Map(before.rows.map((row) => [`${row.key}.${row.posture}`, row]));
  const table = mapRows(after, (row) => {
    const was = old.get(`${row.key}.${row.posture}`);
    if (!was || was === row || !isForeign(row)) return row;
    const kept = withCells(row, (cell, col) => {
      if (cell === was.cells[col]) return cell;
      proposed.push({ row: was, col, cell });
      return was.cells[col]!;
    });
    return kept.cells.every((cell, col) => cell === was.cells[col]) ? was : kept;
  });
  const isSame = table.rows.length === before.rows.length;
  const isBefore = isSame && table.rows.every((row, at) => row === before.rows[at]);
  return { table: isBefore ? before : table, proposed };
}
