// Tests of the chance to win by score and clock (client/web/src/core/chance.ts).

import assert from "node:assert/strict";
import test from "node:test";
import { chanceNow, chanceOf, chancesOf } from "../../../client/web/src/core/chance.ts";
import { Phase } from "../../../client/web/src/core/wire.gen.ts";

const near = (found, expected, within) =>
  assert.ok(Math.abs(found - expected) < within, `${found}`);
const sheet = (volatility = 0.5, seats = 2, duration_s = 180) => ({
  seats: Array.from({ length: seats }, () => ({})),
  duration_s,
  settings: { match: { lead_volatility: volatility } },
});
const frame = (phase, playedS, ...scores) => ({
  phase,
  clock_ticks: 50 * playedS,
  seats: scores.map((score) => ({ score })),
});

test("a lead is worth more the shorter the rest, and both sides add up", () => {
  near(chanceOf(0, 100, 0.5), 0.5, 1e-9);
  near(chanceOf(5, 100, 0.5), 0.841345, 1e-6); // one standard deviation
  near(chanceOf(-10, 100, 0.5), 0.02275, 1e-6);
  let last = 0.5;
  for (const restS of [180, 90, 30, 5, 1, 0]) {
    const chance = chanceOf(3, restS, 0.5);
    assert.ok(chance > last || chance === 1);
    near(chance + chanceOf(-3, restS, 0.5), 1, 1e-9);
    last = chance;
  }
  assert.deepEqual([chanceOf(1, 0, 0.5), chanceOf(0, 0, 0.5), chanceOf(-1, 0, 0.5)], [1, 0.5, 0]);
});

test("a chance is told in play only, and where the arena says how far a lead wanders", () => {
  near(chanceNow(frame(Phase.PLAYING, 80, 7, 2), sheet()), 0.841345, 1e-6);
  near(chanceNow(frame(Phase.HALTED, 80, 2, 7), sheet()), 0.158655, 1e-6);
  assert.equal(chanceNow(frame(Phase.PLAYING, 3, 7, 2), sheet()), null, "too early");
  assert.equal(chanceNow(frame(Phase.FINISHED, 180, 7, 2), sheet()), null);
  assert.equal(chanceNow(frame(Phase.PLAYING, 80, 7), sheet(0.5, 1)), null);
  assert.equal(chanceNow(frame(Phase.PLAYING, 80, 7, 2), sheet(0.5, 2, 0)), null);
  assert.equal(chanceNow(frame(Phase.PLAYING, 80, 7, 2), sheet(0)), null);
  assert.equal(chanceNow(frame(Phase.PLAYING, 80, 7, 2), { ...sheet(), settings: {} }), null);
});

test("a recorded match has a chance at each second and each change, and halts take no time", () => {
  const record = {
    sheets: [{ beat: 0, value: sheet(0.5, 2, 4) }],
    phases: [
      { beat: 0, value: Phase.COUNTDOWN },
      { beat: 100, value: Phase.PLAYING },
      { beat: 200, value: Phase.HALTED },
      { beat: 500, value: Phase.PLAYING },
      { beat: 600, value: Phase.FINISHED },
    ],
    scores: [
      { beat: 0, value: [0, 0] },
      { beat: 170, value: [2, 0] },
    ],
    lastBeat: 700,
  };
  const moments = chancesOf(record);
  assert.deepEqual(
    moments.map(({ beat }) => beat),
    [100, 150, 169, 170, 200, 500, 550, 600],
  );
  near(moments[2].chance, 0.5, 1e-9);
  near(moments[3].chance, chanceOf(2, 4 - 1.4, 0.5), 1e-9);
  assert.deepEqual([moments[4].clock_s, moments[5].clock_s], [2, 2]);
  assert.equal(moments[4].chance, moments[5].chance);
  assert.equal(moments.at(-1).chance, 1);
  assert.deepEqual(chancesOf({ ...record, sheets: [{ beat: 0, value: sheet(0) }] }), []);
});
