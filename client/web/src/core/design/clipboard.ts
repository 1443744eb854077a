/** Reads and writes blocks of cells in the form in which spreadsheets put them on the clipboard. */

import { htmlCells } from "./html_block";
import { rowsOfKey } from "./rows";
import {
  type Area,
  joint,
  LEVELS,
  numberOf,
  readCell,
  setArea,
  type Table,
  type Wrong,
  wrongOf,
} from "./table";

/** A cell of a block that can't be pasted, with the place in the table where it would stand. */
export interface BadPaste {
  row: number;
  col: number;
  text: string;
  why: Wrong | "outside";
}

/** The result of a paste: the changed table, or the cells because of which nothing was changed. */
export type Pasted = { table: Table; area: Area } | { bad: BadPaste[] };

/** Most bad cells that one paste lists. */
const MOST_BAD = 1000;

const KEY = /^(\d)\s*key$/i;
const HEADER = /^num of postures?$/i;
const LEGEND = /^(id of joint|position)$/i;

/**
 * Read what is on the clipboard.
 *
 * @param plain The clipboard's `text/plain`.
 * @param html The clipboard's `text/html`; it is only read if there is no plain text.
 * @returns Rows of equal length; [] if there is nothing.
 */
export function readBlock(plain: string, html = ""): string[][] {
  const text = plain.replace(/^\uFEFF/, "");
  return even(text === "" && html ? htmlCells(html) : tabbedCells(text));
}

/** Write cells as spreadsheets do: a tab between cells, CR LF at the end of each row. */
export function writeBlock(cells: readonly (readonly (string | number)[])[]): string {
  return cells.map((row) => `${row.map(quoted).join("\t")}\r\n`).join("");
}

/** Whether a block is a whole gait file with its header, which the gateway must read as a file. */
export function isWholeSheet(block: readonly (readonly string[])[]): boolean {
  const [first, second] = block
    .map((row) => row.map((cell) => cell.normalize("NFKC").trim()))
    .filter((row) => row.some(Boolean));
  if (!first || !second) return false;
  if (HEADER.test(first[0]!)) return true;
  const isCount = (row: string[]) =>
    /^\d+$/.test(row[0]!) && row.slice(1).every((cell) => cell === "");
  return first.length > 1 && isCount(first) && isCount(second);
}

/**
 * Put a block into a table, as a whole or not at all.
 *
 * A single cell fills the whole selection. A larger block begins at the first selected cell. In a
 * table of postures, a row that begins with the name of a key ("2 Key") goes to this key.
 *
 * @param at The selection.
 */
export function paste(table: Table, at: Area, block: readonly (readonly string[])[]): Pasted {
  const cells = withoutBlankEdge(spacedCells(block));
  const named = table.kind === "postures" ? namedRows(table, cells) : null;
  if (named) return named;
  const isOne = cells.length === 1 && cells[0]!.length === 1;
  const filled = isOne ? filling(at, cells[0]![0]!) : cells;
  return pasteAt(table, at.top, at.left, filled);
}

function pasteAt(table: Table, top: number, left: number, cells: string[][]): Pasted {
  const bad: BadPaste[] = [];
  for (const [r, line] of cells.entries()) {
    for (const [c, text] of line.entries()) {
      const [row, col] = [top + r, left + c];
      const range = row < table.rows.length ? table.ranges[col] : undefined;
      const why = range ? wrongOf(readCell(text, range)) : "outside";
      if (why) bad.push({ row, col, text, why });
      if (bad.length === MOST_BAD) return { bad };
    }
  }
  if (bad.length) return { bad };
  const bottom = top + Math.max(1, cells.length) - 1;
  const right = left + Math.max(1, cells[0]?.length ?? 0) - 1;
  const area = { top, left, bottom, right };
  return { table: setArea(table, { row: top, col: left }, cells), area };
}

/** Paste rows that begin with names of keys; null if one has no name, or a key comes twice. */
function namedRows(table: Table, cells: string[][]): Pasted | null {
  const named = cells
    .filter((line) => !isLegend(line))
    .map((line) => ({ key: Number(KEY.exec(line[0]!.normalize("NFKC").trim())?.[1]), line }));
  const keys = new Set(named.map(({ key }) => key));
  if (!keys.size || keys.size < named.length || keys.has(Number.NaN)) return null;
  const whole = named.reduce((made, { key }) => withKey(made, key), table);
  const width = joints(table);
  const lines = named.map(({ key, line }) => {
    const angles = Array.from(
      { length: Math.max(width, line.length - 1) },
      (_, id) => line[id + 1],
    );
    return { row: rowsOfKey(whole, key)[0]!, angles: angles.map((angle) => angle ?? "") };
  });
  let next = whole;
  const bad: BadPaste[] = [];
  for (const { row, angles } of lines) {
    const pasted = pasteAt(next, row, 0, [angles]);
    if ("bad" in pasted) bad.push(...pasted.bad);
    else next = pasted.table;
  }
  if (bad.length) return { bad };
  const rows = lines.map(({ row }) => row);
  const [top, bottom] = [Math.min(...rows), Math.max(...rows)];
  return { table: next, area: { top, left: 0, bottom, right: width - 1 } };
}

/** Whether a row names the columns, or is empty: it has no angles. */
function isLegend([name, ...cells]: string[]): boolean {
  const text = name!.trim();
  return LEGEND.test(text) || (text === "" && cells.every((cell) => numberOf(cell) === null));
}

const joints = (table: Table) => joint(0, LEVELS.length, table.legs.length);

/** The table; if it has no row for a key yet, with such a row. */
function withKey(table: Table, key: number): Table {
  if (rowsOfKey(table, key).length) return table;
  const added = { key, posture: 0, cells: table.rows[0]!.cells };
  const rows = [...table.rows, added].toSorted((one, other) => one.key - other.key);
  return { ...table, rows };
}

function filling({ top, left, bottom, right }: Area, text: string): string[][] {
  return Array.from({ length: bottom - top + 1 }, () => Array(right - left + 1).fill(text));
}

/** Split each row of numbers at spaces, as in a text file, if all rows are such rows. */
function spacedCells(block: readonly (readonly string[])[]): string[][] {
  const split = (row: readonly string[]) => row[0]!.trim().split(/\s+/);
  const areNumbers = (row: readonly string[]) =>
    row.length === 1 &&
    split(row).length > 1 &&
    split(row).every((cell) => numberOf(cell) !== null);
  return even(block.every(areNumbers) ? block.map(split) : block);
}

/** Remove empty rows at the bottom and empty columns on the right. */
function withoutBlankEdge(cells: string[][]): string[][] {
  const isBlank = (cell: string | undefined) => cell === undefined || cell.trim() === "";
  const height = cells.findLastIndex((row) => !row.every(isBlank)) + 1;
  const width = most(cells, (row) => row.findLastIndex((cell) => !isBlank(cell)) + 1);
  return cells.slice(0, height).map((row) => row.slice(0, width));
}

/** Fill rows with empty cells, so that all have the same length. */
function even(rows: readonly (readonly string[])[]): string[][] {
  const width = most(rows, (row) => row.length);
  return rows.map((row) => [...row, ...Array<string>(width - row.length).fill("")]);
}

/** The largest number that `of` gives for a row; `Math.max` can't take millions of numbers. */
function most<T>(rows: readonly T[], of: (row: T) => number): number {
  return rows.reduce((largest, row) => Math.max(largest, of(row)), 0);
}

/** Split text into cells at tabs and line ends, except those inside a cell in quotes. */
function tabbedCells(text: string): string[][] {
  const rows: string[][] = [];
  let row: string[] = [];
  let at = 0;
  while (at < text.length) {
    const end = quoteEnd(text, at) ?? cellEnd(text, at);
    row.push(unquoted(text.slice(at, end)));
    at = end;
    if (text[at] === "\t") {
      at++;
      if (at < text.length) continue;
      row.push("");
    }
    if (at < text.length) at += text.startsWith("\r\n", at) ? 2 : 1;
    rows.push(row);
    row = [];
  }
  return rows;
}

/** The index at which a cell without quotes ends. */
function cellEnd(text: string, from: number): number {
  let at = from;
  while (at < text.length && !"\t\r\n".includes(text[at]!)) at++;
  return at;
}

/** The index at which a cell in quotes ends; null: the cell is not in quotes. */
function quoteEnd(text: string, from: number): number | null {
  if (text[from] !== '"') return null;
  for (let at = text.indexOf('"', from + 1); at >= 0; at = text.indexOf('"', at + 2)) {
    if (text[at + 1] !== '"') return cellEnd(text, at + 1) === at + 1 ? at + 1 : null;
  }
  return null;
}

/** The text of a cell without its quotes; a text with a quote only at its beginning stays. */
function unquoted(cell: string): string {
  const isQuoted = quoteEnd(cell, 0) === cell.length;
  return isQuoted ? cell.slice(1, -1).replaceAll('""', '"') : cell;
}

function quoted(cell: string | number): string {
  const text = String(cell);
  return /[\t\r\n"]/.test(text) ? `"${text.replaceAll('"', '""')}"` : text;
}
