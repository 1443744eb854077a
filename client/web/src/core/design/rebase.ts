/** Takes over into one table what others changed in another: so undo keeps what others did. */

import { type Row, type Table, withCells } from "./table";

/**
 * What leads from one table to another, as a function of any table of their shape. Where the two
 * tables have other shapes, it gives the second one; a table of yet another shape stays as it is.
 * The same table always gives the same object.
 */
export function changesBetween(from: Table, to: Table): (table: Table) => Table {
  const before = byPlace(from);
  const after = byPlace(to);
  const isSameShape = from.kind === to.kind && from.legs.length === to.legs.length;
  const isSameRobot = from.legs === to.legs && from.ranges === to.ranges;
  const differs = (place: string) => before.get(place) !== after.get(place);
  const changed = new Set([...before.keys(), ...after.keys()].filter(differs));
  const made = new Map<Table, Table>([[from, to]]);
  const change = (table: Table): Table => {
    if (table.kind !== from.kind || table.legs.length !== from.legs.length) return table;
    if (!isSameShape) return to;
    const rows: Row[] = [];
    const added = new Set([...changed].filter((place) => !before.has(place)));
    for (const row of table.rows) {
      const place = placeOf(row);
      added.delete(place);
      const [old, now] = [before.get(place), after.get(place)];
      if (!changed.has(place) || !old) rows.push(row);
      else if (now) rows.push(merged(row, old, now));
    }
    for (const place of added) rows.push(after.get(place)!);
    const isSame = isSameRobot && rows.length === table.rows.length;
    if (isSame && rows.every((row, at) => row === table.rows[at])) return table;
    if (added.size) rows.sort((one, other) => one.key - other.key || one.posture - other.posture);
    return { ...table, legs: to.legs, ranges: to.ranges, rows };
  };
  return (table) => {
    let now = made.get(table);
    if (!now) {
      now = change(table);
      made.set(table, now);
    }
    return now;
  };
}

function merged(row: Row, old: Row, now: Row): Row {
  if (row === old) return now;
  return withCells(row, (cell, col) =>
    old.cells[col] === now.cells[col] ? cell : now.cells[col]!,
  );
}

function placeOf({ key, posture }: Row): string {
  return `${key}.${posture}`;
}

function byPlace(table: Table): Map<string, Row> {
  return new Map(table.rows.map((row) => [placeOf(row), row]));
}
