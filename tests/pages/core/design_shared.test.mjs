// Tests of a table that several pages edit (client/web/src/core/design/shared_table.ts and beside).

import assert from "node:assert/strict";
import { test } from "node:test";
import { cellNamed, digestOf, NO_FILE_ENTRY } from "../../../client/web/src/core/design/entries.ts";
import { History } from "../../../client/web/src/core/design/history.ts";
import { Outbox } from "../../../client/web/src/core/design/outbox.ts";
import { changesBetween } from "../../../client/web/src/core/design/rebase.ts";
import { namesFor } from "../../../client/web/src/core/design/row_names.ts";
import { addRow, removeRow } from "../../../client/web/src/core/design/rows.ts";
import { SharedTable } from "../../../client/web/src/core/design/shared_table.ts";
import * as t from "../../../client/web/src/core/design/table.ts";
import { editOf } from "./design_edits.mjs";
import { COLUMNS, chanceOf, SEQUENCES, sample, walking } from "./design_sample.mjs";

/** How often each page edits; tests that may take long say more. */
const EDITS = Number(process.env.EDITS ?? 200);
const contentOf = (table, rest = {}) => ({
  kind: table.kind,
  legs: table.legs.length,
  rows: table.rows,
  keys: SEQUENCES,
  robot: null,
  file: NO_FILE_ENTRY,
  ...rest,
});

/** The table in a document; rows that are as before stay the same objects, as on a page. */
function tableOf({ kind, rows }, before = { rows: [] }) {
  const known = new Map(before.rows.map((row) => [`${row.key}.${row.posture}`, row]));
  const same = (row) => {
    const old = known.get(`${row.key}.${row.posture}`);
    return old?.cells.every((cell, col) => cell === row.cells[col]) ? old : row;
  };
  return { kind, ...COLUMNS, rows: rows.map(same) };
}

/** Somebody at a table: edits, undoes, and now and then has no connection. */
class Writer {
  constructor() {
    this.outbox = new Outbox();
    this.shared = new SharedTable((update, names) => this.outbox.add(update, names, false));
    this.isOnline = true;
    this.missed = [];
  }

  open(state) {
    this.shared.take(state);
    this.history = new History(tableOf(this.shared.content()));
  }

  write() {
    this.shared.write(contentOf(this.history.table.value));
  }

  take(update) {
    const before = this.shared.rowNames();
    this.shared.take(update);
    const after = this.shared.rowNames();
    const moved = (row) => {
      const at = after.indexOf(before[row]);
      return at < 0 ? null : at;
    };
    this.history.rebase(tableOf(this.shared.content(), this.history.table.value), moved);
  }
}

/** Passes on what writers send, in any order between them. */
function deliver(writers) {
  for (const writer of writers.filter(({ isOnline }) => isOnline)) {
    const parcel = writer.outbox.next(0);
    if (parcel) writer.outbox.confirmed();
    for (const other of writers) {
      if (other === writer || !parcel) continue;
      if (other.isOnline) other.take(parcel.update);
      else other.missed.push(parcel.update);
    }
    for (const update of writer.missed.splice(0)) writer.take(update);
  }
}

// Rows that are inserted at the same time all stay: tables of sequences become long, and slow.
for (const [first, rounds] of [
  [sample, EDITS],
  [walking, 0.3 * EDITS],
]) {
  test(`four pages edit and undo ${rounds} times each, with outages, and converge: ${first.kind}`, () => {
    const chance = chanceOf(5);
    const writers = Array.from({ length: 4 }, () => new Writer());
    const begun = new SharedTable(() => undefined);
    begun.write(contentOf(first));
    for (const writer of writers) writer.open(begun.state());
    for (let edits = 0; edits < rounds; edits++) {
      for (const writer of writers) {
        const { history } = writer;
        const what = chance();
        if (what < 0.1) history.undo();
        else if (what < 0.2) history.redo();
        else history.apply("edit", editOf(chance));
        writer.write();
        if (chance() < 0.02) writer.isOnline = !writer.isOnline;
      }
      if (chance() < 0.1) deliver(writers);
    }
    for (const writer of writers) writer.isOnline = true;
    for (let round = 0; round < 3; round++) deliver(writers);
    const [one, ...others] = writers.map(({ shared }) => JSON.stringify(shared.content()));
    for (const other of others) assert.equal(other, one);
    for (const { history, shared, outbox } of writers) {
      assert.equal(digestOf(history.table.value), digestOf(shared.content()));
      assert.ok(outbox.isEmpty);
    }
  });
}

test("nothing that somebody typed is lost, unless somebody typed into the same cell", () => {
  const chance = chanceOf(9);
  const below = (count) => Math.floor(chance() * count);
  const writers = Array.from({ length: 4 }, () => new Writer());
  const begun = new SharedTable(() => undefined);
  begun.write(contentOf(sample));
  for (const writer of writers) writer.open(begun.state());
  // Each writer has the columns of a leg level; two meet only where they are told to.
  const typed = new Map();
  for (let number = 1; number <= EDITS; number++) {
    writers.forEach((writer, who) => {
      const [row, col] = [below(9), 4 * below(4) + who];
      const angle = (number % 149) + who / 10;
      writer.history.apply("type", (table) => t.setCell(table, row, col, String(angle)));
      writer.write();
      typed.set(`${row} ${col}`, angle);
      if (chance() < 0.02) writer.isOnline = !writer.isOnline;
    });
    if (chance() < 0.1) deliver(writers);
  }
  for (const writer of writers) writer.isOnline = true;
  for (let round = 0; round < 3; round++) deliver(writers);
  for (const { history } of writers) {
    for (const [place, angle] of typed) {
      const [row, col] = place.split(" ").map(Number);
      assert.equal(history.table.value.rows[row].cells[col], angle);
    }
  }
});

test("undo takes back one's own steps, and keeps what others did", () => {
  const history = new History(sample);
  history.apply("one", (table) => t.setCell(table, 1, 0, "11"));
  history.apply("two", (table) => t.setCell(table, 2, 0, "22"));
  history.rebase(t.setCell(history.table.value, 3, 5, "33"));
  assert.equal(history.undoName.value, "two");
  history.undo();
  history.undo();
  const { rows } = history.table.value;
  assert.deepEqual(
    [rows[1].cells[0], rows[2].cells[0]],
    [45, 45].map((_, at) => sample.rows[at + 1].cells[0]),
  );
  assert.equal(rows[3].cells[5], 33);
  history.redo();
  assert.equal(history.table.value.rows[1].cells[0], 11);
  // Somebody types over one's own number: there is nothing to take back any more.
  history.rebase(t.setCell(history.table.value, 1, 0, "12"));
  assert.equal(history.canUndo.value, false);
  assert.equal(history.table.value.rows[1].cells[0], 12);
  assert.equal(history.redoName.value, "two");
});

test("a row that one page removes and another one edits stays", () => {
  const [one, other] = [new Writer(), new Writer()];
  const begun = new SharedTable(() => undefined);
  begun.write(contentOf(sample));
  for (const writer of [one, other]) writer.open(begun.state());
  one.history.apply("remove", (table) => ({ ...table, rows: table.rows.toSpliced(3, 1) }));
  one.write();
  other.history.apply("type", (table) => t.setCell(table, 3, 2, "7"));
  other.write();
  for (let round = 0; round < 2; round++) deliver([one, other]);
  for (const { history } of [one, other]) {
    const row = history.table.value.rows.find(({ key }) => key === 3);
    assert.deepEqual(row.cells, sample.rows[3].cells.with(2, 7));
  }
});

test("other tables, robots and files come over, and an angle out of range stays a number", () => {
  const updates = [];
  const one = new SharedTable((update) => updates.push(update));
  const other = new SharedTable(() => assert.fail("it wrote nothing"));
  const robot = { name: "my.toml", text: "[body]\n" };
  const file = { name: "Loco-data.txt", version: "ab", digest: digestOf(sample), robotVersion: "" };
  one.write(contentOf(sample, { robot, file, keys: ["0", "", "12"] }));
  one.write(contentOf(walking, { robot, file, keys: ["0", "", "12"] }));
  for (const update of updates) other.take(update);
  const found = other.content();
  assert.deepEqual(found.rows, walking.rows);
  assert.deepEqual([found.robot, found.file, found.keys], [robot, file, ["0", "", "12"]]);
  const wide = t.fromWire(
    { kind: "postures", legs: 6, rows: [{ key: 0, posture: 0, angles_deg: Array(18).fill(170) }] },
    COLUMNS,
  );
  assert.equal(typeof wide.rows[0].cells[0], "string");
  const far = new SharedTable(() => undefined);
  far.write(contentOf({ ...wide, rows: [{ ...wide.rows[0], cells: Array(18).fill(170) }] }));
  const before = far.state().length;
  far.write(contentOf(wide));
  assert.equal(far.state().length, before, "the page of a narrower robot writes nothing");
});

test("an outbox keeps the order, sends one parcel at a time, and again after a break", () => {
  const outbox = new Outbox();
  const shared = new SharedTable((update, names) => outbox.add(update, names, false));
  shared.write(contentOf(sample));
  const first = outbox.next(3);
  shared.write(contentOf(t.setCell(sample, 1, 1, "5")));
  assert.equal(outbox.next(4), null);
  outbox.returned();
  const again = outbox.next(5);
  assert.deepEqual([first.seen, again.seen], [3, 3], "it was typed before 4 and 5 were seen");
  assert.ok(again.update.length > first.update.length);
  assert.ok(again.names.includes("p6/1.0/1"));
  assert.deepEqual(cellNamed("p6/1.0/1"), { key: 1, rank: 0, col: 1 });
  const copy = new SharedTable(() => undefined);
  copy.take(again.update);
  assert.deepEqual(copy.content(), shared.content());
  outbox.confirmed();
  assert.ok(outbox.isEmpty);
  assert.equal(shared.missingIn(copy.state()), null);
});

test("changes of one table come over into another one of its shape", () => {
  const now = t.setCell(sample, 2, 2, "9");
  const change = changesBetween(sample, now);
  const own = t.setCell(sample, 4, 4, "8");
  assert.equal(change(sample), now);
  assert.deepEqual([change(own).rows[2].cells[2], change(own).rows[4].cells[4]], [9, 8]);
  assert.equal(change(walking), walking);
  assert.equal(changesBetween(sample, walking)(own), walking);
});

/** Two writers at the same table of sequences. */
function pair(first = walking) {
  const writers = [new Writer(), new Writer()];
  const begun = new SharedTable(() => undefined);
  begun.write(contentOf(first));
  for (const writer of writers) writer.open(begun.state());
  return writers;
}

const meet = (writers) => {
  for (let round = 0; round < 2; round++) deliver(writers);
};

test("what is typed into a row of a sequence stays in it while others insert and remove rows", () => {
  const [one, other] = pair();
  one.history.apply("add", (table) => addRow(table, 1));
  one.history.apply("type", (table) => t.setCell(table, 2, 0, "1"));
  one.write();
  other.history.apply("type", (table) => t.setCell(table, 2, 2, "7"));
  other.history.apply("type", (table) => t.setCell(table, 3, 3, "8"));
  other.write();
  meet([one, other]);
  for (const { history } of [one, other]) {
    const { rows } = history.table.value;
    assert.deepEqual(rows[2].cells, walking.rows[1].cells.with(0, 1));
    assert.deepEqual(rows[3].cells, walking.rows[2].cells.with(2, 7));
    assert.deepEqual(rows[4].cells, walking.rows[3].cells.with(3, 8));
    assert.equal(rows.length, walking.rows.length + 1);
  }
  // Undo takes one's own number out of the row that has moved.
  other.history.undo();
  other.write();
  one.history.apply("remove", (table) => removeRow(table, 1));
  one.write();
  meet([one, other]);
  for (const { history } of [one, other]) {
    const { rows } = history.table.value;
    assert.deepEqual(rows[2].cells, walking.rows[2].cells.with(2, 7));
    assert.deepEqual(rows[3].cells, walking.rows[3].cells);
  }
  other.history.undo();
  assert.deepEqual(other.history.table.value.rows[2].cells, walking.rows[2].cells);
});

test("two rows that are inserted at the same place at the same time are two", () => {
  const [one, other] = pair();
  for (const [writer, angle] of [
    [one, "1"],
    [other, "2"],
  ]) {
    writer.history.apply("add", (table) => addRow(table, 0));
    writer.history.apply("type", (table) => t.setCell(table, 1, 0, angle));
    writer.write();
  }
  meet([one, other]);
  const rows = one.history.table.value.rows;
  assert.deepEqual(new Set([rows[1].cells[0], rows[2].cells[0]]), new Set([1, 2]));
  assert.deepEqual(other.history.table.value.rows, rows);
});

test("of ten thousand pages that insert at one place each draws another name", () => {
  const [{ shared, history }] = pair();
  history.apply("add", (table) => addRow(table, 0));
  const names = new Set();
  for (let number = 0; number < 10_000; number++) {
    const content = contentOf(history.table.value);
    for (const name of namesFor(content, shared.entries, () => (number + 0.5) / 10_000)) {
      names.add(name);
    }
  }
  assert.equal(names.size, walking.rows.length + 10_000);
});

test("rows can be added at one place again and again, and ranks stay short", () => {
  const [{ shared, history }] = pair();
  const first = history.table.value.rows.length;
  for (let number = 0; number < 40; number++) {
    history.apply("add", (table) => addRow(table, 0));
    history.apply("type", (table) => t.setCell(table, 1, 0, String(number)));
    shared.write(contentOf(history.table.value));
    assert.deepEqual(shared.content().rows, history.table.value.rows);
  }
  assert.equal(shared.rowNames().length, first + 40);
  for (const name of shared.rowNames()) assert.match(name, /^l6\/\d\.\d{1,2}(_\d{1,12})?$/);
});

test("what is not confirmed goes over into a fresh document: rows, keys and proposals too", () => {
  const [one] = pair(sample);
  const fresh = new SharedTable(() => undefined);
  fresh.take(one.shared.state());
  one.history.apply("remove", (table) => removeRow(table, 3));
  one.history.apply("type", (table) => t.setCell(table, 1, 1, "5"));
  const keys = SEQUENCES.with(2, "12");
  one.shared.write(contentOf(one.history.table.value, { keys }));
  one.shared.propose([["p6/4.0/2", "9"]], "Ann");
  fresh.put([...one.outbox.names].map((name) => [name, one.shared.get(name)]));
  assert.deepEqual(fresh.content(), one.shared.content());
  assert.deepEqual(fresh.content().keys, keys);
  assert.deepEqual(fresh.proposals(), one.shared.proposals());
});
