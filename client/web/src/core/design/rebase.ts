/** Takes over into one table what others changed in another: so undo keeps what others did. */

import { MAX_POSTURES_PER_KEY } from "../wire";
import { aligned } from "./row_names";
import { type Row, type Table, withCells } from "./table";

/** Where a row of one table is in another one; null: nowhere. */
export type Moved = (row: number) => number | null;

/**
 * What leads from one table to another, as a function of any table of their shape. Where the two
 * tables have other shapes, it gives the second one; a table of yet another shape stays as it is.
 * The same table always gives the same object.
 *
 * @param moved Where the rows of sequences are: they have no names in a table.
 */
export function changesBetween(
  from: Table,
  to: Table,
  moved: Moved = (row) => row,
): (table: Table) => Table {
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
    const count = from.rows.length;
    const isStill = count === to.rows.length && from.rows.every((_, row) => moved(row) === row);
    if (from.kind === "locomotion" && !(isStill && count === table.rows.length)) {
      const rows = moveInto(table, from, to, moved);
      const isBefore = isSameRobot && rows.length === table.rows.length;
      return isBefore && rows.every((row, at) => row === table.rows[at]) ? table : { ...to, rows };
    }
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

/** The rows of a table of sequences with what others did: rows that they inserted or removed too. */
function moveInto(table: Table, from: Table, to: Table, moved: Moved): readonly Row[] {
  const isSame = (one: number, other: number) => sameCells(from.rows[one]!, table.rows[other]!);
  const old = aligned([...from.rows.keys()], [...table.rows.keys()], isSame);
  const places: (number | null)[] = from.rows.map((_, row) => moved(row));
  if (!places.some((place) => place !== null)) {
    // All have got other names: the numbers must tell which rows are the same.
    const back = aligned<number, Row>([...places.keys()], to.rows, (one, row) =>
      sameCells(from.rows[one]!, row),
    );
    back.forEach((row, at) => {
      if (row !== null) places[row] = at;
    });
  }
  const whereFrom = new Map(places.map((place, row) => [place, row]));
  const ownAt = new Map(old.map((row, own) => [row, own]));
  const taken = new Set<number>();
  const rows: { row: Row; own: number }[] = [];
  to.rows.forEach((row, at) => {
    const before = whereFrom.get(at);
    const own = before === undefined ? -1 : (ownAt.get(before) ?? -1);
    taken.add(own);
    if (own >= 0) rows.push({ row: merged(table.rows[own]!, from.rows[before!]!, row), own });
    else if (before === undefined) rows.push({ row, own });
  });
  table.rows.forEach((row, own) => {
    if (taken.has(own)) return;
    // Others removed a row that has nothing of this step.
    const before = old[own];
    if (before != null && places[before] === null && sameCells(from.rows[before]!, row)) return;
    const at = rows.findLastIndex((one) => one.own >= 0 && one.own < own);
    rows.splice(at + 1, 0, { row, own });
  });
  return numbered(rows.map(({ row }) => row));
}

function numbered(rows: readonly Row[]): Row[] {
  const sorted = rows.toSorted((one, other) => one.key - other.key);
  const counts = new Map<number, number>();
  return sorted.flatMap((row) => {
    const posture = counts.get(row.key) ?? 0;
    counts.set(row.key, posture + 1);
    if (posture >= MAX_POSTURES_PER_KEY) return [];
    return [posture === row.posture ? row : { ...row, posture }];
  });
}

const sameCells = (one: Row, other: Row) =>
  one === other ||
  (one.key === other.key &&
    (one.cells === other.cells || one.cells.every((cell, col) => cell === other.cells[col])));

function merged(row: Row, old: Row, now: Row): Row {
  if (row === old) return now;
  const mine = withCells(row, (cell, col) =>
    old.cells[col] === now.cells[col] ? cell : now.cells[col]!,
  );
  return mine.key === now.key ? mine : { ...mine, key: now.key };
}

function placeOf({ key, posture }: Row): string {
  return `${key}.${posture}`;
}

function byPlace(table: Table): Map<string, Row> {
  return new Map(table.rows.map((row) => [placeOf(row), row]));
}
