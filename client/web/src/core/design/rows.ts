/** Adds and removes rows of a table, and finds the rows of a key. */

import { MAX_KEYS, MAX_POSTURES_PER_KEY } from "../wire";
import type { Row, Table } from "./table";

/** Whether a row can be added after a row. */
export function canAdd(table: Table, after: number): boolean {
  if (table.kind === "postures") return freeKey(table) !== null;
  const key = table.rows[after]?.key ?? -1;
  return rowsOfKey(table, key).length < MAX_POSTURES_PER_KEY;
}

/**
 * Add a copy of a row. In a table of postures the copy gets the lowest free key. In a table of
 * locomotion it stands right after the row, in the same key. Without room the table stays as it is.
 */
export function addRow(table: Table, after: number): Table {
  const row = table.rows[after];
  if (!row || !canAdd(table, after)) return table;
  if (table.kind === "postures") {
    return sorted(table, [...table.rows, { ...row, key: freeKey(table)! }]);
  }
  return numbered(table, table.rows.toSpliced(after + 1, 0, row));
}

/** Add a key with a copy of a row as its only posture; without room the table stays as it is. */
export function addKey(table: Table, from: number): Table {
  if (table.kind === "postures") return addRow(table, from);
  const key = keysOf(table).length;
  const row = table.rows[from];
  if (!row || key >= MAX_KEYS) return table;
  return { ...table, rows: [...table.rows, { key, posture: 0, cells: row.cells }] };
}

/** Whether a row can be removed: the keys of locomotion have no gaps, and one row stays. */
export function canRemove(table: Table, row: number): boolean {
  const found = table.rows[row];
  if (!found || table.rows.length < 2) return false;
  if (table.kind === "postures") return true;
  return rowsOfKey(table, found.key).length > 1 || found.key === keysOf(table).length - 1;
}

/** Remove a row; the table stays as it is if the row can't be removed. */
export function removeRow(table: Table, row: number): Table {
  if (!canRemove(table, row)) return table;
  return numbered(table, table.rows.toSpliced(row, 1));
}

/** The digits of the keys, in ascending order. */
export function keysOf(table: Table): number[] {
  return [...new Set(table.rows.map(({ key }) => key))];
}

/** The indices of the rows of a key. */
export function rowsOfKey(table: Table, key: number): number[] {
  return [...table.rows.keys()].filter((row) => table.rows[row]!.key === key);
}

/**
 * The indices of the rows that a key of level B runs through; null if the key has none, or if the
 * table lacks one of them.
 *
 * @param sequences For a table of postures: for each key from 0 on, the digits of its postures.
 */
export function sequenceOf(
  table: Table,
  key: number,
  sequences: readonly string[],
): number[] | null {
  if (table.kind === "locomotion") {
    const rows = rowsOfKey(table, key);
    return rows.length ? rows : null;
  }
  const rows = [...(sequences[key] ?? "")].map((digit) => rowsOfKey(table, Number(digit))[0]);
  return rows.length && rows.every((row) => row !== undefined) ? rows : null;
}

function freeKey(table: Table): number | null {
  const taken = new Set(keysOf(table));
  for (let key = 0; key < MAX_KEYS; key++) if (!taken.has(key)) return key;
  return null;
}

function sorted(table: Table, rows: Row[]): Table {
  return { ...table, rows: rows.toSorted((one, other) => one.key - other.key) };
}

/** Number the postures of each key of locomotion. */
function numbered(table: Table, rows: Row[]): Table {
  if (table.kind === "postures") return { ...table, rows };
  const counts = new Map<number, number>();
  const counted = rows.map((row) => {
    const posture = counts.get(row.key) ?? 0;
    counts.set(row.key, posture + 1);
    return posture === row.posture ? row : { ...row, posture };
  });
  return { ...table, rows: counted };
}
