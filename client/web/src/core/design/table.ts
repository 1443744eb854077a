/**
 * The table of a gait that the page edits: rows of angles in degrees, by joint id (rules 1 and 2).
 *
 * A table is never changed: every edit returns a new table. Unchanged rows are the same objects.
 */

import type { FileTable, RobotReply } from "../wire";

/** An angle [deg]; a text if what was typed is no angle in the joint's range: it is shown red. */
export type Cell = number | string;

export interface Row {
  /** The digit key, 0 to 9. */
  readonly key: number;
  /** Place in the key's sequence; 0 in a table of postures. */
  readonly posture: number;
  /** By joint id. */
  readonly cells: readonly Cell[];
}

export type Range = readonly [number, number];

export interface Table {
  /** Loco-data has one posture for each key; LocoTra-data has a sequence for each. */
  readonly kind: "postures" | "locomotion";
  /** Labels of the legs, clockwise from the right front. */
  readonly legs: readonly string[];
  /** Lowest and highest angle of each joint [deg]. */
  readonly ranges: readonly Range[];
  /** By key, then by posture. */
  readonly rows: readonly Row[];
}

/** A rectangle of cells: first and last row, first and last joint id. */
export interface Area {
  readonly top: number;
  readonly left: number;
  readonly bottom: number;
  readonly right: number;
}

/** The numbers of a robot that make the columns of a table. */
export interface Columns {
  readonly legs: readonly string[];
  readonly ranges: readonly Range[];
}

/** A table of the wire format, but cells may have texts. */
export interface WireTable extends Omit<FileTable, "rows"> {
  rows: readonly { key: number; posture: number; angles_deg: readonly Cell[] }[];
}

/** Why a cell has no angle. */
export type Wrong = "empty" | "number" | "range";

/** A cell without an angle. */
export interface BadCell {
  row: number;
  col: number;
  why: Wrong;
}

/** The joints of a leg, from the body outward. */
export const LEVELS = ["Root", "1st", "2nd"] as const;
/** Postures of a table to begin with. */
const STANDING_KEYS = 9;
/** The range of a joint if no robot says another (workshop 3-1) [deg]. */
export const USUAL_RANGE: Range = [-150, 150];
/** Sums of angles are rounded to a multiple of 1 / EXACT degrees. */
const EXACT = 1e9;
/** Most characters that a cell keeps of a typed text. */
const MOST_TEXT = 100;

const NUMBER = /^[+-]?(\d+([.,]\d*)?|[.,]\d+)(e[+-]?\d+)?$/i;
/** Full-width forms of ASCII, and half-width forms of "。", "、" and "ー". */
const FORMS = /[\uFF01-\uFF5E\uFF61\uFF64\uFF70]/g;
/** Characters that count as a minus: dashes, the minus sign, and the Japanese long vowel mark. */
const MINUS = /(^|e)[\u2010-\u2015\u2212\u30FC]/gi;

/** The joint id of a leg's joint (rules 1). */
export const joint = (leg: number, level: number, legs: number) => leg + legs * level;

/** Leg and level of a joint id. */
export const legAndLevel = (id: number, legs: number) => ({
  leg: id % legs,
  level: Math.floor(id / legs),
});

/**
 * The number in a text; null: the text is no number. It may have a decimal point or a comma, and
 * full-width digits. "ー", "。" and "、" count as minus and decimal points, because a Japanese
 * input method types them for these keys. Files take the same signs (lacoc_shared/gait/cells.py).
 */
export function numberOf(text: string): number | null {
  const plain = text
    .replace(FORMS, (form) => form.normalize("NFKC")) // of other forms, "①45" would become 145
    .trim()
    .replace(MINUS, "$1-")
    .replace(/[。、]/, ".");
  const number = plain.replace(/\s*°$/, "");
  return NUMBER.test(number) ? Number(number.replace(",", ".")) + 0 : null;
}

/** Read what was typed: an angle within the range, else the text itself. */
export function readCell(text: string, range: Range): Cell {
  const angle = numberOf(text);
  const fits = angle !== null && angle >= range[0] && angle <= range[1];
  return fits ? angle : text.trim().slice(0, MOST_TEXT);
}

/** Why a cell has no angle; null: it has one. */
export function wrongOf(cell: Cell): Wrong | null {
  if (typeof cell === "number") return null;
  if (cell === "") return "empty";
  return numberOf(cell) === null ? "number" : "range";
}

/** All cells without an angle, by row. */
export function badCells(table: Table): BadCell[] {
  return table.rows.flatMap(({ cells }, row) =>
    cells.flatMap((cell, col) => {
      const why = wrongOf(cell);
      return why ? [{ row, col, why }] : [];
    }),
  );
}

/** The columns of a robot, for `fromWire` and `refit`. */
export function columnsOf(robot: RobotReply): Columns {
  return { legs: robot.legs, ranges: robot.ranges_deg };
}

/** Make a table from a table of the wire format; angles outside the ranges become texts. */
export function fromWire(wire: WireTable, columns: Columns): Table {
  const fits = wire.legs === columns.legs.length;
  const legs = fits ? columns.legs : Array.from({ length: wire.legs }, (_, leg) => String(leg));
  const ranges = fits ? columns.ranges : legs.flatMap(() => LEVELS.map(() => USUAL_RANGE));
  const rows = wire.rows.map(({ key, posture, angles_deg }) => ({
    key,
    posture,
    cells: angles_deg.map((angle, col) => readCell(String(angle), ranges[col] ?? USUAL_RANGE)),
  }));
  return { kind: wire.kind, legs, ranges, rows };
}

/** Make a table to begin with: all postures are that in which the robot stands. */
export function standing(robot: RobotReply): Table {
  const rows = Array.from({ length: STANDING_KEYS }, (_, key) => ({
    key,
    posture: 0,
    angles_deg: robot.start_deg,
  }));
  return fromWire({ kind: "postures", legs: robot.legs.length, rows }, columnsOf(robot));
}

/** The table in the wire format; null while a cell has no angle. */
export function toWire(table: Table): FileTable | null {
  if (badCells(table).length) return null;
  const rows = table.rows.map(({ key, posture, cells }) => ({
    key,
    posture,
    angles_deg: cells as number[],
  }));
  return { kind: table.kind, legs: table.legs.length, rows };
}

/** The table with another robot's labels and ranges; null: it has another number of legs. */
export function refit(table: Table, { legs, ranges }: Columns): Table | null {
  if (legs.length !== table.legs.length) return null;
  const rows = table.rows.map((row) =>
    withCells(row, (cell, col) => readCell(String(cell), ranges[col]!)),
  );
  return { ...table, legs, ranges, rows };
}

/** The area with two cells as opposite corners. */
export function areaOf(one: { row: number; col: number }, other = one): Area {
  return {
    top: Math.min(one.row, other.row),
    left: Math.min(one.col, other.col),
    bottom: Math.max(one.row, other.row),
    right: Math.max(one.col, other.col),
  };
}

/** The cells of an area. */
export function cellsOf(table: Table, area: Area): Cell[][] {
  return table.rows
    .slice(area.top, area.bottom + 1)
    .map((row) => row.cells.slice(area.left, area.right + 1));
}

/** Type into a cell. */
export function setCell(table: Table, row: number, col: number, text: string): Table {
  return change(table, areaOf({ row, col }), (_, range) => readCell(text, range));
}

/** Put a block into a table, its first cell at a place; cells outside the table are left out. */
export function setArea(
  table: Table,
  at: { row: number; col: number },
  block: readonly (readonly string[])[],
): Table {
  const { row: top, col: left } = at;
  const bottom = top + block.length - 1;
  const right = left + Math.max(0, ...block.map((line) => line.length)) - 1;
  return change(table, { top, left, bottom, right }, (cell, range, row, col) => {
    const text = block[row - top]?.[col - left];
    return text === undefined ? cell : readCell(text, range);
  });
}

/** Add degrees to the angles of an area, but keep them in their ranges; texts stay. */
export function nudge(table: Table, area: Area, byDeg: number): Table {
  return change(table, area, (cell, [low, high]) => {
    if (typeof cell === "string") return cell;
    return Math.min(high, Math.max(low, Math.round((cell + byDeg) * EXACT) / EXACT)) + 0;
  });
}

/** Empty the cells of an area. */
export function clear(table: Table, area: Area): Table {
  return change(table, area, () => "");
}

/** Change each cell of an area with a function. */
export function change(
  table: Table,
  { top, left, bottom, right }: Area,
  edit: (cell: Cell, range: Range, row: number, col: number) => Cell,
): Table {
  return mapRows(table, (row, index) => {
    if (index < top || index > bottom) return row;
    return withCells(row, (cell, col) =>
      col < left || col > right ? cell : edit(cell, table.ranges[col]!, index, col),
    );
  });
}

/** Change each row with a function; if none changes, return the same table. */
export function mapRows(table: Table, edit: (row: Row, index: number) => Row): Table {
  const rows = table.rows.map(edit);
  return rows.every((row, index) => row === table.rows[index]) ? table : { ...table, rows };
}

/** Change each cell of a row with a function; if none changes, return the same row. */
export function withCells(row: Row, edit: (cell: Cell, col: number) => Cell): Row {
  const cells = row.cells.map(edit);
  return cells.every((cell, col) => cell === row.cells[col]) ? row : { ...row, cells };
}
