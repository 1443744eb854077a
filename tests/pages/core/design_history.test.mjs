// Tests of undo (client/web/src/core/design/history.ts).

import assert from "node:assert/strict";
import { test } from "node:test";
import { History } from "../../../client/web/src/core/design/history.ts";
import * as t from "../../../client/web/src/core/design/table.ts";
import { editOf } from "./design_edits.mjs";
import { COLUMNS, chanceOf, sample, walking } from "./design_sample.mjs";

for (const [name, first] of Object.entries({ postures: sample, locomotion: walking })) {
  test(`1,000 random steps can be undone and redone: ${name}`, () => {
    const chance = chanceOf(11);
    const history = new History(first);
    const seen = () => JSON.stringify([history.table.value, history.version.value]);
    const states = [seen()];
    for (let tries = 0; states.length <= 1000; tries++) {
      assert.ok(tries < 5000, "edits change nothing");
      const before = history.version.value;
      history.apply(String(states.length), editOf(chance));
      if (history.version.value !== before) states.push(seen());
    }
    assert.ok(history.table.value.rows.length <= 1000);
    for (let step = 1000; step >= 0; step--) {
      assert.equal(seen(), states[step]);
      assert.equal(history.undoName.value, step ? String(step) : "");
      assert.equal(history.canUndo.value, step > 0);
      history.undo();
    }
    for (let step = 0; step <= 1000; step++) {
      assert.equal(seen(), states[step]);
      assert.equal(history.redoName.value, step < 1000 ? String(step + 1) : "");
      assert.equal(history.canRedo.value, step < 1000);
      history.redo();
    }
    const versions = new Map();
    for (const [table, version] of states.map((state) => JSON.parse(state))) {
      const content = JSON.stringify(table.rows);
      assert.equal(versions.get(content) ?? version, version);
      versions.set(content, version);
    }
    assert.equal(new Set(versions.values()).size, versions.size);
  });
}

const turn = (by) => (table) => t.nudge(table, t.areaOf({ row: 1, col: 0 }), by);

test("equal contents have the same version, whichever steps led to them", () => {
  const history = new History(sample);
  const first = history.version.value;
  history.apply("up", turn(5));
  const up = history.version.value;
  history.apply("down", turn(-5));
  assert.equal(history.version.value, first);
  history.undo();
  assert.equal(history.version.value, up);
  history.apply("down", turn(-5));
  assert.equal(history.canRedo.value, false);
});

test("an edit that changes nothing is no step, and redo still works", () => {
  const history = new History(sample);
  history.apply("up", turn(5));
  history.undo();
  history.apply("nothing", (table) => ({ ...table }));
  assert.deepEqual([history.canUndo.value, history.redoName.value], [false, "up"]);
});

test("one drag of a slider is one step", () => {
  const history = new History(sample);
  for (const by of [1, 1, 1]) history.apply("slide", turn(by), "first drag");
  history.apply("slide", turn(1), "second drag");
  assert.equal(history.table.value.rows[1].cells[0], 4);
  history.undo();
  assert.equal(history.table.value.rows[1].cells[0], 3);
  history.undo();
  assert.equal(history.table.value, sample);
});

test("a drag that ends where it began is no step", () => {
  const history = new History(sample);
  for (const by of [1, 1, -2]) history.apply("slide", turn(by), "drag");
  assert.deepEqual([history.canUndo.value, history.canRedo.value], [false, false]);
  history.apply("slide", turn(3), "drag");
  history.undo();
  assert.equal(history.table.value, sample);
});

test("a change of the robot changes the columns of all steps, and is no step", () => {
  const history = new History(sample);
  history.apply("up", turn(5));
  const version = history.version.value;
  const narrow = { legs: ["a", "b", "c", "d", "e", "f"], ranges: Array(18).fill([-40, 40]) };
  history.refit(narrow);
  assert.deepEqual([history.undoName.value, history.table.value.legs], ["up", narrow.legs]);
  assert.equal(t.wrongOf(history.table.value.rows[0].cells[0]), "range");
  assert.notEqual(history.version.value, version);
  history.undo();
  assert.deepEqual(history.table.value.ranges[0], [-40, 40]);
  history.redo();
  history.refit(COLUMNS);
  assert.equal(history.version.value, version);
  assert.deepEqual(history.table.value.legs, COLUMNS.legs);
});

test("another file begins without steps to undo", () => {
  const history = new History(sample);
  history.apply("up", turn(5));
  const version = history.version.value;
  history.open(walking);
  assert.equal(history.table.value, walking);
  assert.ok(!history.canUndo.value && history.version.value !== version);
});

test("another robot is a step, and each step brings back its own robot", () => {
  const [first, longer, longest] = [{ leg: 70 }, { leg: 80 }, { leg: 90 }];
  const history = new History(sample, first);
  const version = history.version.value;
  const keep = (table) => table;
  history.apply("longer", keep, "leg 1", longer);
  history.apply("longest", keep, "leg 1", longest); // the same gesture
  history.apply("type", (table) => t.setCell(table, 0, 0, "17"));
  assert.equal(history.robot.value, longest);
  history.undo();
  assert.deepEqual([history.robot.value, history.undoName.value], [longest, "longest"]);
  history.undo();
  assert.deepEqual([history.robot.value, history.version.value], [first, version]);
  assert.equal(history.canUndo.value, false);
  history.redo();
  assert.equal(history.robot.value, longest);
});
