// Tests of what a test of the link means (client/web/src/core/link_test.ts).

import assert from "node:assert/strict";
import { test } from "node:test";
import { judge } from "../../../client/web/src/core/link_test.ts";

/** The frames of ten seconds; `atMs` gives the time when one arrives, null: never. */
function frames(atMs = (beat) => 20 * beat, match = 1) {
  const found = [];
  for (let beat = 0; beat < 500; beat++) {
    const at = atMs(beat);
    if (at !== null) found.push({ match, beat, atMs: at });
  }
  return found;
}

/** A hundred round trips: 90 of the first length, 10 of the second [ms]. */
const trips = (most, some = most) => [...Array(90).fill(most), ...Array(10).fill(some)];

const CASES = {
  "a hall": [judge(trips(4, 30), frames()), { verdict: "good", p50Ms: 4, p95Ms: 30, frames: 500 }],
  "another city": [judge(trips(60, 110), frames()), { verdict: "equal", p50Ms: 60, p95Ms: 110 }],
  "another continent": [judge(trips(310), frames()), { verdict: "slow", p50Ms: 310 }],
  "no answers": [judge(trips(4, Infinity), frames()), { verdict: "slow", p50Ms: 4, p95Ms: null }],
  nothing: [judge([], []), { verdict: "slow", p50Ms: null, p95Ms: null, frames: 0 }],
  "no court": [judge(trips(4), []), { verdict: "good", frames: 0, lost: 0, late: 0 }],
  "one frame in a hundred is lost": [
    judge(
      trips(4),
      frames((beat) => (beat % 100 === 7 ? null : 20 * beat)),
    ),
    { verdict: "good", frames: 500, lost: 5, late: 0 },
  ],
  "one frame in thirty is lost": [
    judge(
      trips(4),
      frames((beat) => (beat % 30 === 7 ? null : 20 * beat)),
    ),
    { verdict: "equal", frames: 500, lost: 17 },
  ],
  // Wi-Fi stops for 300 ms every two seconds; then all that waited comes at once.
  "frames come in bursts": [
    judge(
      trips(4),
      frames((beat) => (beat % 100 < 15 ? 20 * (beat - (beat % 100) + 15) : 20 * beat)),
    ),
    { verdict: "slow", lost: 0, late: 40 },
  ],
  "a court at nine tenths of its speed": [
    judge(
      trips(4),
      frames((beat) => 22 * beat),
    ),
    { verdict: "good", lost: 0, late: 0 },
  ],
  "a new match": [
    judge(trips(4), [...frames(), ...frames((beat) => 10_000 + 20 * beat, 2)]),
    { verdict: "good", frames: 1000, lost: 0, late: 0 },
  ],
};

for (const [name, [found, expected]] of Object.entries(CASES)) {
  test(`link test: ${name}`, () => assert.deepEqual({ ...found, ...expected }, found));
}
