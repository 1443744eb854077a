// Tests of the files that a tab keeps (client/web/src/core/files.ts).

import assert from "node:assert/strict";
import { test } from "node:test";

const stored = new Map();
globalThis.sessionStorage = {
  getItem: (name) => stored.get(name) ?? null,
  setItem: (name, text) => stored.set(name, text),
  removeItem: (name) => stored.delete(name),
};
let loads = 0;

/** The module as a page has it that was loaded just now. */
const loaded = () => import(`../../../client/web/src/core/files.ts?load=${loads++}`);
const choose = (page, name) => page.choose(new File(["Num of Posture\t1\n"], name));
/** Names of the postures that a join sends and that are shown, and the keys that a join sends. */
const now = (page) => [
  page.chosenFiles().postures?.name,
  page.chosenNames.value.postures,
  page.chosenSequences()?.join(),
];

test("joins send a change of the files only once it is applied", async () => {
  const page = await loaded();
  await choose(page, "mine.txt");
  assert.deepEqual(now(page), ["mine.txt", "mine.txt", undefined]);
  const change = async () => {
    page.beginChange();
    await choose(page, "other.txt");
    page.sequences.value = ["1"];
    assert.deepEqual(now(page), ["mine.txt", "other.txt", undefined]);
  };
  await change();
  page.cancelChange();
  assert.deepEqual(now(page), ["mine.txt", "mine.txt", undefined]);

  await change();
  assert.deepEqual(now(await loaded()), ["mine.txt", "mine.txt", undefined]);

  page.applyChange();
  page.cancelChange(); // the dialog closes
  assert.deepEqual(now(page), ["other.txt", "other.txt", "1"]);
});

test("a robot file is known by its content too", async () => {
  const { slotOf } = await loaded();
  const slot = (name, text) => slotOf(name, new TextEncoder().encode(text));
  for (const text of ["# My robot\n\n[body]\n", 'name = "Ant"\n', "[body]\r\nmass_kg = 1\r\n"]) {
    assert.equal(slot("robot.toml.txt", text), "robot");
  }
  assert.equal(slot("Robot.TOML", ""), "robot");
  assert.equal(slot("a.txt", "Num of Posture\t1\n1 Key\t0\n"), "postures");
  assert.equal(slot("a.txt", "4\n1\n0\n"), "locomotion");
});
