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
