/** A shared table as a page shows it. */

import type { Content, ProposalEntry } from "./entries";
import {
  type Cell,
  type Columns,
  mapRows,
  type Row,
  readCell,
  type Table,
  USUAL_RANGE,
  withCells,
} from "./table";

const placeOf = ({ key, posture }: Row) => `${key}.${posture}`;

/**
 * The table of a content.
 *
 * @param columns Those of the robot on the page; null: there is none yet.
 * @param before What the page shows: rows that have not changed stay the same objects.
 */
export function pageTable(
  { kind, legs: count, rows }: Content,
  columns: Columns | null,
  before: Table | null,
): Table {
  const fits = columns?.legs.length === count ? columns : null;
  const legs = fits?.legs ?? Array.from({ length: count }, (_, leg) => String(leg));
  const ranges = fits?.ranges ?? Array.from({ length: 3 * count }, () => USUAL_RANGE);
  const shown = before?.legs.length === count ? before.rows : [];
  const known = new Map(shown.map((row) => [placeOf(row), row]));
  return {
    kind,
    legs,
    ranges,
    rows: rows.map((row) => {
      const cells = row.cells.map((cell, col) => readCell(String(cell), ranges[col]!));
      const old = known.get(placeOf(row));
      return old?.cells.every((cell, col) => cell === cells[col]) ? old : { ...row, cells };
    }),
  };
}

/** A table of postures without the numbers of proposals that others have taken in now. */
export function withoutProposed(
  before: Table,
  table: Table,
  proposals: readonly ProposalEntry[],
): Table {
  if (!proposals.length || table.kind !== "postures" || before.kind !== table.kind) return table;
  return mapRows(table, (row) => {
    const old = before.rows.find(({ key }) => key === row.key);
    const isProposed = (cell: Cell, col: number) =>
      proposals.some((one) => one.key === row.key && one.col === col && one.text === String(cell));
    return withCells(row, (cell, col) => (old && isProposed(cell, col) ? old.cells[col]! : cell));
  });
}
