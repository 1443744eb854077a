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
    { moves: 2, points: 5, largest: 3, restarts: 0 },
    { moves: 1, points: 4, largest: 4, restarts: 1 },
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
  assert.deepEqual(figures([], 1), [{ moves: 0, points: 0, largest: 0, restarts: 0 }]);
});
