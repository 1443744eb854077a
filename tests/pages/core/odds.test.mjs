// Tests of the odds of a match (client/web/src/core/odds.ts).

import assert from "node:assert/strict";
import test from "node:test";
import { chanceAt, highlights, readOdds } from "../../../client/web/src/core/odds.ts";

const moment = (beat, chance) => ({ beat, clock_s: beat / 50, chance });
const file = {
  format: 1,
  match_id: "m",
  moments: [moment(100, 0.5), moment(400, 0.6), moment(200, 0.9), moment(500, 0.58)],
};

test("odds of this match are read, in order; anything else gives null", () => {
  assert.deepEqual(
    readOdds(file, "m").moments.map(({ beat }) => beat),
    [100, 200, 400, 500],
  );
  for (const other of [
    null,
    "odds",
    { ...file, format: 2 },
    { ...file, moments: [] },
    { ...file, moments: [moment(1, 0.5), moment(2, 1.5)] },
    { ...file, moments: [moment(1, 0.5), { beat: 2 }] },
  ]) {
    assert.equal(readOdds(other, "m"), null);
  }
  assert.equal(readOdds(file, "another"), null);
});

test("between two moments the chance is on the line between them", () => {
  const odds = readOdds(file, "m");
  assert.equal(chanceAt(odds, 0), 0.5);
  assert.ok(Math.abs(chanceAt(odds, 150) - 0.7) < 1e-9);
  assert.ok(Math.abs(chanceAt(odds, 300) - 0.75) < 1e-9);
  assert.equal(chanceAt(odds, 9000), 0.58);
});

test("highlights are the largest changes, the largest first", () => {
  const found = highlights(readOdds(file, "m"));
  assert.deepEqual(
    found.map(({ before }) => before.beat),
    [100, 200],
  );
  assert.deepEqual([found[0].after.beat, found[1].after.beat], [200, 400]);
  assert.ok(found[0].change > 0 && found[1].change < 0);
  assert.equal(highlights(readOdds(file, "m"), 1).length, 1);
});
