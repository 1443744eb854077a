/**
 * A table as the entries of a shared document: client/lacoc_client/workshop/tables/entries.py lists
 * their names.
 */

import { type Cell, numberOf, type Row } from "./table";

export type Entry = number | string | boolean;

/** A robot's file. */
export interface RobotText {
  name: string;
  text: string;
}

/** Which file has the table, as far as somebody saved or opened one. */
export interface FileEntry {
  /** "": none. */
  name: string;
  version: string;
  /** `digestOf` the table that it has. */
  digest: string;
  /**
   * Version of the file that the robot was made from, where that file lacks the robot's changes;
   * "": it has no file; null: nothing is lacking.
   */
  robotVersion: string | null;
}

/** All that pages of one table share. */
export interface Content {
  kind: "postures" | "locomotion";
  legs: number;
  rows: readonly Row[];
  /** The digits of each key of level B. */
  keys: readonly string[];
  /** null: the workshop's robot. */
  robot: RobotText | null;
  file: FileEntry;
}

/** A cell by the name of its entry: the digit of its key, its rank in the key, and the joint id. */
export interface CellName {
  key: number;
  /** Of two rows the one with the lower rank comes first; 0 in a table of postures. */
  rank: number;
  col: number;
}

const PLACE = /^[pl]\d+\/(\d)\.(\d+(?:_\d+)?)(?:\/(\d+))?$/;

/** What somebody proposes for a cell. */
export interface ProposalEntry extends CellName {
  /** Name of its entry. */
  name: string;
  text: string;
  by: string;
}

/** The proposal that an entry is; null: it is none. */
export function proposalIn(name: string, entry: Entry): ProposalEntry | null {
  const cell = name.endsWith("?") ? cellNamed(name.slice(0, -1)) : null;
  const value = parsed<{ text: string; by: string } | null>(entry, null);
  return cell && value ? { ...cell, name, text: String(value.text), by: String(value.by) } : null;
}

/** The shape of a table, with which the names of its cells begin. */
export const shapeOf = ({ kind, legs }: Pick<Content, "kind" | "legs">) => `${kind[0]}${legs}`;

/** The name of a posture's entry. */
export const postureEntry = (shape: string, key: number) => `${shape}/${key}.0`;

/** The cell that an entry is; null: it is no cell. */
export function cellNamed(name: string): CellName | null {
  const found = PLACE.exec(name);
  if (found?.[3] === undefined) return null;
  return { key: Number(found[1]), rank: rankOf(found[2]!), col: Number(found[3]) };
}

/** The names of all rows of a shape, in their order. */
export function rowNames(names: Iterable<string>, shape: string): string[] {
  const rows: { name: string; key: number; rank: number }[] = [];
  for (const name of names) {
    const found = name.startsWith(`${shape}/`) ? PLACE.exec(name) : null;
    if (found && found[3] === undefined) {
      rows.push({ name, key: Number(found[1]), rank: rankOf(found[2]!) });
    }
  }
  rows.sort((one, other) => one.key - other.key || one.rank - other.rank);
  return rows.map(({ name }) => name);
}

/** The digit of a row's key, in its name. */
export const keyIn = (name: string) => Number(PLACE.exec(name)?.[1]);

/** The rank in a row's name, as text. */
export const rankIn = (name: string) => PLACE.exec(name)?.[2] ?? "0";

/** A rank as a number: "1_5" stands between "1" and "2". */
export const rankOf = (text: string) => Number(text.replace("_", "."));

/** The content in a document; null while it has no table. */
export function contentOf(
  entries: ReadonlyMap<string, Entry> | { get(name: string): Entry | undefined },
  names: Iterable<string>,
): Content | null {
  const shape = String(entries.get("shape") ?? "");
  if (!shape) return null;
  const kind = shape[0] === "l" ? "locomotion" : "postures";
  const legs = Number(shape.slice(1));
  const rows = rowNames(names, shape).map((name) => ({
    key: keyIn(name),
    posture: 0,
    cells: cellsIn(entries, name, legs),
  }));
  return {
    kind,
    legs,
    rows: kind === "locomotion" ? numbered(rows) : rows,
    keys: String(entries.get("keys") ?? "").split(","),
    robot: parsed<RobotText | null>(entries.get("robot"), null),
    file: parsed<FileEntry>(entries.get("file"), NO_FILE_ENTRY),
  };
}

/** The cells of a row. */
export function cellsIn(
  entries: { get(name: string): Entry | undefined },
  name: string,
  legs: number,
): Cell[] {
  return Array.from(
    { length: 3 * legs },
    (_, col) => (entries.get(`${name}/${col}`) ?? "") as Cell,
  );
}

export const NO_FILE_ENTRY: FileEntry = { name: "", version: "", digest: "", robotVersion: null };

/** The entries of a content but for rows and cells. */
export function headEntries(content: Content): [string, Entry][] {
  return [
    ["shape", shapeOf(content)],
    ["keys", content.keys.join(",")],
    ["robot", content.robot ? JSON.stringify(content.robot) : ""],
    ["file", JSON.stringify(content.file)],
  ];
}

/** Whether an entry has what a cell shows; a number out of range is a text on a page. */
export function isSameCell(entry: Entry | undefined, cell: Cell): boolean {
  if (entry === cell) return true;
  return typeof entry === "number" && typeof cell === "string" && numberOf(cell) === entry;
}

/** A short name of the content of a table: other contents have other names. */
export function digestOf({ kind, rows }: Pick<Content, "kind" | "rows">): string {
  const text = JSON.stringify([kind, rows.map(({ key, posture, cells }) => [key, posture, cells])]);
  // Two rounds of FNV-1a, from both ends: 64 bits.
  let [one, other] = [0x811c9dc5, 0xc9dc5118];
  for (let at = 0; at < text.length; at++) {
    one = Math.imul(one ^ text.charCodeAt(at), 0x01000193);
    other = Math.imul(other ^ text.charCodeAt(text.length - 1 - at), 0x01000193);
  }
  return [one, other].map((half) => (half >>> 0).toString(16).padStart(8, "0")).join("");
}

/** Close the gaps that are left where one page removed rows and another one added some. */
function numbered(rows: Row[]): Row[] {
  const keys = [...new Set(rows.map(({ key }) => key))];
  const counts = new Map<number, number>();
  return rows.map((row) => {
    const posture = counts.get(row.key) ?? 0;
    counts.set(row.key, posture + 1);
    return { key: keys.indexOf(row.key), posture, cells: row.cells };
  });
}

function parsed<T>(entry: Entry | undefined, otherwise: T): T {
  try {
    return typeof entry === "string" && entry ? (JSON.parse(entry) as T) : otherwise;
  } catch {
    return otherwise;
  }
}
