/** What the border of a field says: letters of columns and numbers of rows, by which discs are named. */

import type { MarkerInfo } from "./wire";

/** A disc by its column and row, counted from 0; columns have letters. */
const DISC = /^c(1?[0-9]|2[0-5])r([0-9]{1,2})$/;
const NUMBERED = /^(corner|flag)([0-9]{1,4})$/;

/** What pictures write beside a marker: "C4", "16"; "" for markers of other games. */
export function markerLabel(name: string): string {
  const [, column, row] = DISC.exec(name) ?? [];
  if (row) return `${String.fromCharCode(65 + Number(column))}${Number(row) + 1}`;
  return NUMBERED.exec(name)?.[2] ?? "";
}

/** Whether a marker is a numbered "corner" or "flag"; "" for any other. */
export function markerKind(name: string): string {
  return NUMBERED.exec(name)?.[1] ?? "";
}

export interface Border {
  /** Letters with their x [m]. */
  columns: [string, number][];
  /** Numbers with their y [m]. */
  rows: [string, number][];
}

/** The border of a board of discs; empty for other markers. */
export function borderOf(markers: readonly MarkerInfo[]): Border {
  const columns = new Map<string, number>();
  const rows = new Map<string, number>();
  for (const { name, x_m, y_m } of markers) {
    const [, column, row] = /^([A-Z])(\d+)$/.exec(markerLabel(name)) ?? [];
    if (!column || !row) continue;
    columns.set(column, x_m);
    rows.set(row, y_m);
  }
  return { columns: [...columns], rows: [...rows] };
}

/** What stands at a marker itself; "" where the border names it. */
export function ownLabel({ name }: MarkerInfo): string {
  const label = markerLabel(name);
  return /^\d/.test(label) ? label : "";
}
