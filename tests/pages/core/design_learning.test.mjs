// Tests of what is told of edits as a student's work (client/web/src/pages/design/learning).

import assert from "node:assert/strict";
import { test } from "node:test";
import { Refused, Unanswered } from "../../../client/web/src/core/connection.ts";
import { toWire } from "../../../client/web/src/core/design/table.ts";
import { Learning } from "../../../client/web/src/pages/design/learning/learning.ts";
import { sample } from "./design_sample.mjs";

globalThis.window = globalThis;

/** A page's table and its `Learning`, at a gateway that `answer`s each request. */
function pupil(answer) {
  let table = sample;
  const gateway = {
    isOpen: true,
    state: { peek: () => ({ open: gateway.isOpen }) },
    ask: (what, fields) => answer(what, fields),
  };
  const gait = (one = table) => {
    const wire = toWire(one);
    return wire && { table: wire, robot: null, sequences: null };
  };
  const learning = new Learning(gateway, gait, () => table);
  learning.edited(null);
  const put = (col, cell, by) => {
    learning.tell(by);
    const [first, ...others] = table.rows;
    table = { ...table, rows: [{ ...first, cells: first.cells.with(col, cell) }, ...others] };
    learning.edited(by);
  };
  return { learning, gateway, put };
}

const cellsOf = ({ rows }) => rows[0].angles_deg;

test("what was typed in a break is told one by one, in order, and again where it is too much", async (t) => {
  t.mock.timers.enable({ apis: ["setTimeout"] });
  const taken = [];
  let open = 0;
  let refusals = 2;
  const { learning, gateway, put } = pupil(async (what, fields) => {
    if (!gateway.isOpen) throw new Unanswered({ code: "page.connection-lost" });
    open += 1;
    await null;
    assert.equal(open, 1, "more than one request is open");
    open -= 1;
    if (refusals-- > 0) throw new Refused({ code: "gateway.too-much" });
    taken.push([what, what === "edit" ? cellsOf(fields.table)[0] : null]);
    return { guess: null };
  });
  learning.greet();
  gateway.isOpen = false;
  for (let angle = 1; angle <= 12; angle++) {
    put(0, angle, "hand");
    learning.tell();
    await new Promise(setImmediate);
  }
  assert.equal(learning.isTold.value, false);
  gateway.isOpen = true;
  learning.greet();
  const sent = learning.send("hand", { up: true });
  for (let turn = 0; turn < 3; turn++) {
    await new Promise(setImmediate);
    t.mock.timers.tick(2000);
  }
  await sent;
  const edits = Array.from({ length: 12 }, (_, index) => ["edit", index + 1]);
  assert.deepEqual(taken, [...edits, ["hand", null]]);
  assert.equal(learning.isTold.value, true);
});

test("what is pasted while a cell is empty does not count as typed, and what was typed before does", () => {
  const told = [];
  const { learning, put } = pupil(async (_, { by, before, table }) => {
    told.push([by, cellsOf(before).slice(0, 3), cellsOf(table).slice(0, 3)]);
    return { guess: null };
  });
  const [, second, third] = sample.rows[0].cells;
  const first = sample.rows[0].cells[0];
  learning.greet();
  put(0, "", "hand");
  put(1, second + 11, "hand");
  put(2, third + 12, "paste");
  put(0, first + 13, "hand");
  learning.tell();
  return new Promise(setImmediate).then(() => {
    assert.deepEqual(told, [
      ["hand", [first, second, third], [first, second + 11, third]],
      ["paste", [first, second + 11, third], [first, second + 11, third + 12]],
      ["hand", [first, second + 11, third + 12], [first + 13, second + 11, third + 12]],
    ]);
    assert.equal(learning.isTold.value, true);
  });
});

test("nothing but an emptied cell is no edit yet: a paste over it counts as pasted", () => {
  const told = [];
  const { learning, put } = pupil(async (_, { by }) => {
    told.push(by);
    return { guess: null };
  });
  learning.greet();
  put(0, "", "hand");
  learning.tell();
  put(0, 17, "paste");
  learning.tell();
  put(0, "", "hand");
  learning.edited(null); // another table is opened
  return new Promise(setImmediate).then(() => {
    assert.deepEqual(told, ["paste"]);
    assert.equal(learning.isTold.value, true);
  });
});
