// Tests of feet that are dragged, and of their ways (client/web/src/core/design/feet.ts).

import assert from "node:assert/strict";
import { test } from "node:test";
import {
  anglesOf,
  bring as brought,
  neighbours,
  wayOf,
} from "../../../client/web/src/core/design/feet.ts";
import { points } from "../../../client/web/src/core/leg/leg.ts";
import { SAMPLES } from "../../../client/web/src/core/leg/samples.gen.ts";
import { chanceOf, sample } from "./design_sample.mjs";

const [LEG] = SAMPLES.hexapod.legs;
const bring = (...given) => {
  const { angles, unreached } = brought(...given);
  assert.equal(unreached, null);
  return angles;
};
const apart = (one, other) => Math.hypot(...one.map((part, axis) => part - other[axis]));
const footOf = (leg, angles) => points(leg, angles)[3];

test("a foot that is brought to where it is keeps its whole degrees", () => {
  const chance = chanceOf(1);
  for (const { legs } of Object.values(SAMPLES)) {
    for (const leg of legs) {
      for (let round = 0; round < 200; round++) {
        const now = [0, 1, 2].map(() => Math.round(-150 + 300 * chance()));
        const found = bring(leg, footOf(leg, now), now);
        // A straight leg, or one folded over its hinge, has the same foot with other angles.
        assert.ok(apart(footOf(leg, found), footOf(leg, now)) < 0.01, `${leg.label} ${now}`);
      }
    }
  }
});

test("a foot comes as near to a point as whole degrees let it, and its knee does not flip", () => {
  const chance = chanceOf(2);
  for (let round = 0; round < 2000; round++) {
    const now = [80 * chance() - 40, 60 * chance() - 20, 60 * chance() - 40].map(Math.round);
    const to = footOf(LEG, now).map((one) => one + 6 * (chance() - 0.5));
    const found = bring(LEG, to, now);
    assert.ok(found.every(Number.isInteger));
    assert.ok(apart(footOf(LEG, found), to) < 2.6, `${now} to ${to}`);
    assert.ok(
      found.every((angle, level) => Math.abs(angle - now[level]) < 20),
      `${now}, ${found}`,
    );
  }
});

test("out of reach says how far, and the leg points there", () => {
  const { angles, unreached } = brought(LEG, [300, 45, -10], [0, 20, 0]);
  assert.equal(unreached.why, "far");
  assert.ok(Math.abs(unreached.by_mm - (300 - 50 - 15 - 140)) < 1e-9);
  assert.deepEqual(angles, [0, 0, 90]);
  const chance = chanceOf(3);
  for (let round = 0; round < 500; round++) {
    const to = [0, 1, 2].map(() => 500 * chance() - 250);
    const found = brought(LEG, to, [0, 20, 0]);
    if (found.unreached?.why !== "far" || !found.angles) continue;
    const [hip, , , foot] = points(LEG, found.angles).map((one) => [...one]);
    const straight = points(LEG, [found.angles[0], 0, 90])[1];
    assert.ok(Math.abs(apart(straight, foot) - 140) < 0.1, "the leg is straight");
    assert.ok(apart(hip, foot) > 100);
  }
});

test("a leg that is too long for a point folds; beyond a joint's range it stays", () => {
  const uneven = { ...LEG, lengths_mm: [15, 90, 40] };
  for (const z of [-10, -30]) {
    const near = brought(uneven, [50 + 15 + 10, 45, z], [0, 20, 0]);
    assert.equal(near.unreached.why, "near");
    const [, hinge, , foot] = points(uneven, near.angles);
    assert.ok(Math.abs(apart(hinge, foot) - (90 - 40)) < 0.5, `${near.angles}`);
    assert.ok(foot[0] > hinge[0] && foot[2] <= hinge[2] + 0.01, "it points there");
  }
  const stiff = { ...LEG, range_deg: [-20.4, 20.4] };
  assert.deepEqual(bring(stiff, footOf(stiff, [20.4, -20.4, 0]), [0, 0, 0]), [20, -20, 0]);
  const { angles, unreached } = brought(stiff, footOf(LEG, [30, 0, 0]), [0, 0, 0]);
  assert.equal(angles, null);
  assert.equal(unreached.why, "range");
});

test("a way is closed and goes through all postures", () => {
  const postures = [1, 2, 3, 4].map((row) =>
    anglesOf(sample.rows[row].cells, Array(18).fill(0), 0),
  );
  const way = wayOf(LEG, postures);
  assert.deepEqual(way[0], way.at(-1));
  for (const posture of postures) {
    assert.ok(way.some((point) => apart(point, footOf(LEG, posture)) < 1e-9));
  }
  assert.deepEqual(wayOf(LEG, []), []);
});

test("a cell without an angle has that of the start posture", () => {
  const start = Array.from({ length: 18 }, (_, joint) => joint);
  const cells = start.map((angle) => (angle === 7 ? "seven" : -angle));
  assert.deepEqual(anglesOf(cells, start, 1), [-1, 7, -13]);
});

test("the postures beside a row are those of the closed sequence", () => {
  assert.deepEqual(neighbours([1, 2, 3, 4], 1), { before: 4, after: 2 });
  assert.deepEqual(neighbours([1, 2, 3, 4], 4), { before: 3, after: 1 });
  for (const [sequence, row] of [
    [null, 1],
    [[1], 1],
    [[1, 2], 5],
  ]) {
    assert.equal(neighbours(sequence, row), null);
  }
});
