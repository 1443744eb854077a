// Tests of the table of a gait (client/web/src/core/design/table.ts, rows.ts, tools.ts).

import assert from "node:assert/strict";
import { execFileSync } from "node:child_process";
import { test } from "node:test";
import { fileURLToPath } from "node:url";
import * as rows from "../../../client/web/src/core/design/rows.ts";
import * as t from "../../../client/web/src/core/design/table.ts";
import * as tools from "../../../client/web/src/core/design/tools.ts";
import { COLUMNS, SEQUENCES, sample, walking } from "./design_sample.mjs";

const names = (table) => table.rows.map(({ key, posture }) => `${key}.${posture}`).join(" ");
const one = (row, col) => t.areaOf({ row, col });

const TYPED = {
  45: 45,
  "-22.5": -22.5,
  "-22,5": -22.5,
  " 7 ": 7,
  "+7": 7,
  "45°": 45,
  "-0": 0,
  "１２．５": 12.5,
  "－４５": -45,
  "−45": -45,
  ー４５: -45,
  "２２。５": 22.5,
  "1e1": 10,
  150: 150,
  150.1: "range",
  "-150": -150,
  "-150.1": "range",
  "1e999": "range",
  "": "empty",
  "  ": "empty",
  abc: "number",
  "4 5": "number",
  "1.000,5": "number",
  "--5": "number",
  "45 °": 45,
  "–45": -45,
  ｰ４５: -45,
  "２２､５": 22.5,
  "1e−1": 0.1,
  ー: "number",
  "–": "number",
  "°": "number",
  "45°°": "number",
  "10–45": "number",
  "4ー5": "number",
  "－ー45": "number",
  "①45": "number",
  "⒈45": "number",
  "4²": "number",
  "1½": "number",
};

test("a typed text becomes an angle, or stays a text with a reason", () => {
  for (const [text, expected] of Object.entries(TYPED)) {
    const cell = t.readCell(text, [-150, 150]);
    assert.deepEqual(t.wrongOf(cell) ?? cell, expected, JSON.stringify(text));
    assert.ok(!Object.is(cell, -0));
  }
});

test("files take the same numbers as the page", () => {
  const signs = Array.from({ length: 0x10000 }, (_, code) => String.fromCharCode(code));
  const shown = signs.filter((sign) => !/[\s\p{C}]/u.test(sign));
  const texts = [
    ...Object.keys(TYPED).filter((text) => text !== "1e999"),
    ...shown.flatMap((sign) => [`${sign}4`, `4${sign}5`, `4${sign}`, `4e${sign}1`]),
  ];
  const script = fileURLToPath(new URL("design_numbers.py", import.meta.url));
  const input = JSON.stringify(texts);
  const read = execFileSync(process.env.PYTHON ?? "python", [script], {
    input,
    maxBuffer: 1 << 24,
  });
  const differ = JSON.parse(read).flatMap((number, index) =>
    number === t.numberOf(texts[index]) ? [] : [texts[index]],
  );
  assert.deepEqual(differ, []);
});

test("a table with a cell without an angle can't be sent", () => {
  const table = t.setCell(t.setCell(sample, 2, 3, "99 bottles"), 4, 0, "200");
  assert.deepEqual(t.badCells(table), [
    { row: 2, col: 3, why: "number" },
    { row: 4, col: 0, why: "range" },
  ]);
  assert.equal(t.toWire(table), null);
  const wider = t.refit(table, { ...COLUMNS, ranges: Array(18).fill([-300, 300]) });
  assert.equal(wider.rows[4].cells[0], 200);
  assert.equal(t.refit(table, { legs: ["a", "b", "c", "d"], ranges: [] }), null);
});

test("a table that is written for the wire and read again is the same", () => {
  for (const table of [sample, walking]) {
    assert.deepEqual(t.fromWire(structuredClone(t.toWire(table)), COLUMNS), table);
  }
});

test("a table with another number of legs than the robot can be shown", () => {
  const wire = {
    kind: "postures",
    legs: 4,
    rows: [{ key: 1, posture: 0, angles_deg: Array(12).fill(9) }],
  };
  const table = t.fromWire(wire, COLUMNS);
  assert.deepEqual([table.legs.length, table.ranges.length, t.badCells(table)], [4, 12, []]);
});

test("nudged angles stay within their ranges", () => {
  const all = t.areaOf({ row: 1, col: 0 }, { row: 2, col: 17 });
  const turned = t.nudge(t.setCell(sample, 1, 0, "x"), all, 120);
  assert.deepEqual(turned.rows[1].cells.slice(0, 3), ["x", 120, 75]);
  assert.equal(turned.rows[2].cells[0], 150);
  assert.equal(turned.rows[0], sample.rows[0]);
  const tenths = Array.from({ length: 3 }).reduce(
    (table) => t.nudge(table, one(0, 1), 0.1),
    sample,
  );
  assert.equal(tenths.rows[0].cells[1], 0.3);
});

test("an edit that changes nothing returns the same table object", () => {
  assert.equal(t.setCell(sample, 0, 0, "45"), sample);
  assert.equal(t.nudge(sample, one(0, 0), 0), sample);
  assert.deepEqual(t.nudge(t.nudge(sample, one(0, 0), 5), one(0, 0), -5), sample);
});

test("rows of postures are added with the lowest free key, and removed", () => {
  const without = rows.removeRow(sample, 3);
  assert.equal(names(without), "0.0 1.0 2.0 4.0 5.0 6.0 7.0 8.0");
  const again = rows.addRow(without, 1);
  assert.equal(names(again), names(sample));
  assert.deepEqual(again.rows[3].cells, sample.rows[1].cells);
  const full = rows.addRow(sample, 0);
  assert.deepEqual(
    [full.rows.length, rows.canAdd(full, 0), rows.addRow(full, 0)],
    [10, false, full],
  );
  const last = sample.rows.reduce((table) => rows.removeRow(table, 0), sample);
  assert.equal(names(last), "8.0");
});

test("postures of locomotion are numbered within their key, and keys have no gaps", () => {
  assert.equal(names(rows.addRow(walking, 2)).slice(0, 27), "0.0 1.0 1.1 1.2 1.3 1.4 2.0");
  assert.equal(names(rows.removeRow(walking, 1)).slice(0, 19), "0.0 1.0 1.1 1.2 2.0");
  assert.ok(!rows.canRemove(walking, 0));
  const more = rows.addKey(walking, 0);
  assert.deepEqual(more.rows.at(-1), { key: 4, posture: 0, cells: walking.rows[0].cells });
  assert.deepEqual(rows.removeRow(more, more.rows.length - 1), walking);
});

test("a key runs through the rows of its sequence", () => {
  assert.deepEqual(rows.sequenceOf(sample, 1, SEQUENCES), [8, 7, 6, 5]);
  assert.deepEqual(rows.sequenceOf(walking, 2, []), [5, 6, 7, 8]);
  assert.equal(rows.sequenceOf(sample, 4, SEQUENCES), null);
  assert.equal(rows.sequenceOf(sample, 0, ["9"]), null);
});

test("keys 3 and 4 of the sample are the mirror of 1 and 2", () => {
  const halves = tools.halvesOf(rows.sequenceOf(sample, 2, SEQUENCES));
  assert.deepEqual(halves, [
    { from: 1, to: 3 },
    { from: 2, to: 4 },
  ]);
  assert.equal(tools.otherHalf(sample, halves), sample);
  const broken = t.clear(sample, t.areaOf({ row: 3, col: 0 }, { row: 4, col: 17 }));
  assert.deepEqual(tools.otherHalf(broken, halves), sample);
  const all = [...sample.rows.keys()];
  assert.deepEqual(tools.mirrorRows(tools.mirrorRows(sample, all), all), sample);
  assert.notEqual(tools.mirrorRows(sample, [1]), sample);
});

test("linked halves follow each other in both directions", () => {
  const halves = tools.halvesOf([1, 2, 3, 4]);
  const first = t.setCell(sample, 1, 0, "30");
  const followed = tools.follow(sample, first, halves);
  assert.equal(followed.rows[3].cells[5], 30);
  const second = t.setCell(followed, 3, 5, "-10");
  assert.equal(tools.follow(followed, second, halves).rows[1].cells[0], -10);
  const both = t.setCell(t.setCell(sample, 1, 0, "30"), 3, 5, "-10");
  assert.equal(tools.follow(sample, both, halves).rows[3].cells[5], 30);
  for (const sequence of [
    [1, 2, 3],
    [1, 2, 1, 2],
  ])
    assert.deepEqual(tools.halvesOf(sequence), []);
});

test("a leg gets the angles of another leg", () => {
  const copied = tools.copyLeg(sample, [1, 3], 0, 5);
  for (const row of [1, 3]) {
    const { cells } = copied.rows[row];
    assert.deepEqual([cells[5], cells[11], cells[17]], [cells[0], cells[6], cells[12]]);
  }
  assert.equal(copied.rows[2], sample.rows[2]);
});

test("only a joint that jumps at the seam is found", () => {
  const sequence = [1, 2, 3, 4];
  const jumps = (table) =>
    tools.seam(table, sequence).flatMap(({ jumps }, id) => (jumps ? [id] : []));
  assert.deepEqual(jumps(sample), []);
  const slow = [10, 20, 30, 40].reduce(
    (table, angle, index) => t.setCell(table, sequence[index], 8, String(angle)),
    sample,
  );
  assert.deepEqual(jumps(slow), [8]);
  assert.deepEqual(tools.seam(slow, sequence)[8], { stepDeg: 30, otherDeg: 10, jumps: true });
  assert.deepEqual(jumps(t.clear(slow, one(2, 8))), []);
  const little = sequence.reduce(
    (table, row, index) => t.setCell(table, row, 8, `${index}`),
    sample,
  );
  assert.deepEqual(jumps(little), []);
  assert.deepEqual(tools.seam(sample, [1]), []);
});
