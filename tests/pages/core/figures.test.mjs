/** The figures of a match on its result card. */

import assert from "node:assert/strict";
import { test } from "node:test";
import { decisive, figures } from "../../../client/web/src/core/figures.ts";

let number = 0;
const event = (kind, seat, data = {}) => ({ number: ++number, beat: number, kind, seat, data });
const scores = (seat, points) => event("flip", seat, { marker: "c0r0", also: [], points });

test("what was scored is counted, but not what was taken back", () => {
  const back = scores(0, 9);
  const events = [
    scores(0, 2),
    scores(1, 4),
    scores(0, 3),
    back,
    event("restart", 1),
    event("decision", -1, { decision: "take-back", arguments: { event: back.number } }),
  ];
  assert.deepEqual(figures(events, 2), [
    { moves: 2, points: 5, largest: 3, restarts: 0, walkedM: 0, keys: 0, often: [] },
    { moves: 1, points: 4, largest: 4, restarts: 1, walkedM: 0, keys: 0, often: [] },
  ]);
  assert.equal(decisive(events, 0), events[2]);
  assert.equal(decisive(events, 1), events[1]);
  assert.equal(decisive(events, -1), events[1]);
});

test("the last of equal moves is the decisive one", () => {
  const events = [scores(0, 2), scores(0, 2)];
  assert.equal(decisive(events, 0), events[1]);
});

test("a match without a score has no decisive move", () => {
  assert.equal(decisive([event("phase", -1)], 0), null);
  assert.equal(figures([], 1)[0].moves, 0);
});

test("walks and keys are those that the court counted", () => {
  const keys = { B0: 2, B2: 7, x: 9, B1: 4, B3: 1 };
  const verdict = { seats: [{ walked_m: 3.25, keys }, {}] };
  const [left, right] = figures([], 2, verdict);
  assert.equal(left.walkedM, 3.25);
  assert.equal(left.keys, 14);
  assert.deepEqual(left.often, [
    ["B2", 7],
    ["B1", 4],
    ["B0", 2],
  ]);
  assert.deepEqual([right.walkedM, right.keys, right.often], [0, 0, []]);
});
