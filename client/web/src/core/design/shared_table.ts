/**
 * A table that several pages edit at once: a Yjs document with an entry for each cell.
 *
 * Documents that have merged the same updates show the same table, in whatever order they came. Of
 * two numbers for a cell the later one stays; where neither page had seen the other's, all pages
 * keep the same one.
 */

import * as Y from "yjs";
import {
  type Content,
  cellNamed,
  contentOf,
  type Entry,
  headEntries,
  isSameCell,
  type ProposalEntry,
  proposalIn,
  rowNames,
  shapeOf,
} from "./entries";
import { namesFor } from "./row_names";

const OWN = "own";

export class SharedTable {
  private readonly doc = new Y.Doc();
  private readonly entries = this.doc.getMap<Entry>("table");
  /** Names of the entries that the write that is under way has changed. */
  private names: string[] = [];

  /** @param told Gets each update of this page, with the names of the entries that it changes. */
  constructor(told: (update: Uint8Array, names: readonly string[]) => void) {
    this.doc.on("update", (update: Uint8Array, origin: unknown) => {
      if (origin !== OWN) return;
      const names = [...new Set(this.names)];
      this.names = [];
      told(update, names);
    });
  }

  get isEmpty(): boolean {
    return this.entries.size === 0;
  }

  /** The table; null: there is none yet. */
  content(): Content | null {
    return contentOf(this.entries, this.entries.keys());
  }

  /** The names of the rows, in the order in which `content` has them. */
  rowNames(): string[] {
    return rowNames(this.entries.keys(), String(this.entries.get("shape") ?? ""));
  }

  /** The cells among entries, as places in the table; cells of rows that are gone are left out. */
  placesOf(names: readonly string[]): { row: number; col: number }[] {
    const rows = this.rowNames();
    return names.flatMap((name) => {
      const row = rows.indexOf(name.slice(0, name.lastIndexOf("/")));
      const cell = cellNamed(name);
      return cell && row >= 0 ? [{ row, col: cell.col }] : [];
    });
  }

  /** An entry, such as that of a cell. */
  get(name: string): Entry | undefined {
    return this.entries.get(name);
  }

  /** Change what differs from a content, in one update; nothing differs: nothing happens. */
  write(content: Content): void {
    const shape = shapeOf(content);
    this.doc.transact(() => {
      if (this.entries.get("shape") !== shape) this.forgetRows();
      for (const [name, value] of headEntries(content)) this.set(name, value);
      const rows = namesFor(content, this.entries);
      content.rows.forEach((row, at) => {
        const name = rows[at]!;
        let isChanged = !this.entries.has(name);
        row.cells.forEach((cell, col) => {
          if (isSameCell(this.entries.get(`${name}/${col}`), cell)) return;
          this.set(`${name}/${col}`, cell);
          isChanged = true;
        });
        // Said again: another page may have removed the row at the same time.
        if (isChanged) this.say(name, true);
      });
      const kept = new Set(rows);
      // The cells of a row that was removed stay, for whoever goes on with it.
      for (const name of this.rowNames()) if (!kept.has(name)) this.drop(name);
    }, OWN);
  }

  /** Set entries as they are; undefined: remove them. */
  put(entries: Iterable<readonly [string, Entry | undefined]>): void {
    this.doc.transact(() => {
      for (const [name, value] of entries) {
        if (value === undefined) this.drop(name);
        else this.set(name, value);
      }
    }, OWN);
  }

  /** What is proposed in the table that there is. */
  proposals(): ProposalEntry[] {
    const shape = `${this.entries.get("shape")}/`;
    return [...this.entries.entries()].flatMap(([name, entry]) => {
      const found = name.startsWith(shape) ? proposalIn(name, entry) : null;
      return found ? [found] : [];
    });
  }

  /** Propose values for cells, by the names of the cells. */
  propose(values: Iterable<readonly [string, string]>, by: string): void {
    this.doc.transact(() => {
      for (const [name, text] of values) this.set(`${name}?`, JSON.stringify({ text, by }));
    }, OWN);
  }

  /** Remove entries, such as proposals. */
  remove(names: readonly string[]): void {
    this.doc.transact(() => {
      for (const name of names) this.drop(name);
    }, OWN);
  }

  /** Merge an update of another page. */
  take(update: Uint8Array): void {
    Y.applyUpdate(this.doc, update, "other");
  }

  /** The whole document as an update. */
  state(): Uint8Array {
    return Y.encodeStateAsUpdate(this.doc);
  }

  /** What a document of this state lacks; null: nothing. */
  missingIn(state: Uint8Array): Uint8Array | null {
    const known = state.length ? Y.encodeStateVectorFromUpdate(state) : undefined;
    const update = Y.encodeStateAsUpdate(this.doc, known);
    const { structs } = Y.decodeUpdate(update);
    return structs.length ? update : null;
  }

  private set(name: string, value: Entry): void {
    if (this.entries.get(name) !== value) this.say(name, value);
  }

  private say(name: string, value: Entry): void {
    this.entries.set(name, value);
    this.names.push(name);
  }

  private drop(name: string): void {
    if (!this.entries.has(name)) return;
    this.entries.delete(name);
    this.names.push(name);
  }

  private forgetRows(): void {
    for (const name of [...this.entries.keys()]) if (name.includes("/")) this.drop(name);
  }
}

/** Updates as one. */
export function mergedUpdates(updates: readonly Uint8Array[]): Uint8Array {
  return updates.length === 1 ? updates[0]! : Y.mergeUpdates([...updates]);
}
