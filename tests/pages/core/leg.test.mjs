// Tests of one leg's triangles and of feet that stand (client/web/src/core/leg).

import assert from "node:assert/strict";
import { execFileSync } from "node:child_process";
import { test } from "node:test";
import { fileURLToPath } from "node:url";
import { decode } from "../../../client/web/node_modules/@msgpack/msgpack/dist.esm/index.mjs";
import { bent, bodyWay, inverse, points, spots } from "../../../client/web/src/core/leg/leg.ts";
import { lesson } from "../../../client/web/src/core/leg/lesson.ts";
import { SAMPLES } from "../../../client/web/src/core/leg/samples.gen.ts";
import { margin } from "../../../client/web/src/core/leg/stance.ts";

const SCRIPT = fileURLToPath(new URL("../../common/leg_feet.py", import.meta.url));
const written = execFileSync(process.env.PYTHON ?? "python", [SCRIPT], { maxBuffer: 1 << 26 });
const numbers = (bytes) => new Float64Array(bytes.slice().buffer);
const drawn = Object.entries(decode(new Uint8Array(written))).map(([name, parts]) => {
  const [angles, feet] = parts.map(numbers);
  return { name, legs: SAMPLES[name].legs, angles, feet };
});
const HEXAPOD = SAMPLES.hexapod.legs;
const [LEG] = HEXAPOD;

/** Each drawn posture of each leg, or one of `every` so many, with MuJoCo's foot. */
function* postures({ legs, angles, feet }, every = 1) {
  const joints = 3 * legs.length;
  for (let at = 0; at * joints < angles.length; at += every) {
    for (const [index, leg] of legs.entries()) {
      const posture = [0, 1, 2].map((level) => angles[at * joints + index + level * legs.length]);
      const from = 3 * (at * legs.length + index);
      yield { leg, posture, foot: [...feet.slice(from, from + 3)] };
    }
  }
}

const apart = (one, other) => Math.hypot(...one.map((part, axis) => part - other[axis]));

test("in 10,000 random postures of each sample robot each foot is where MuJoCo has it", (t) => {
  for (const robot of drawn) {
    let worst = 0;
    for (const { leg, posture, foot } of postures(robot)) {
      worst = Math.max(worst, apart(points(leg, posture)[3], foot));
    }
    t.diagnostic(`${robot.name}: largest error ${worst} mm`);
    assert.equal(robot.angles.length, 30_000 * robot.legs.length);
    assert.ok(worst < 0.01, `${robot.name}: ${worst} mm`);
  }
});

test("the inverse has the posture that leads to a foot, and all its postures lead there", () => {
  for (const robot of drawn) {
    const counts = new Set();
    for (const { leg, posture, foot } of postures(robot, 10)) {
      const found = inverse(leg, foot);
      counts.add(found.postures.length);
      for (const one of found.postures) {
        assert.ok(apart(points(leg, one)[3], foot) < 1e-6);
        for (const angle of one) assert.ok(Math.abs(angle) <= leg.range_deg[1] + 1e-9);
      }
      const nearest = Math.min(...found.postures.map((one) => apart(one, posture)));
      assert.ok(nearest < 1e-3, `${robot.name}: ${posture} is not in ${found.postures}`);
    }
    assert.deepEqual([...counts].sort(), [1, 2, 3, 4], robot.name);
  }
});

test("the sample posture 20, 0 has its foot at 104.7 and -41.8 mm; the other bend is out of range", () => {
  const foot = spots(LEG, 20, 0)[2];
  assert.deepEqual([foot.r.toFixed(1), foot.z.toFixed(1)], ["104.7", "-41.8"]);
  const rounded = ({ postures }) =>
    postures.map((one) => one.map((angle) => Math.round(angle) + 0));
  assert.deepEqual(rounded(bent(LEG, foot)), [[20, 0]]);
  assert.deepEqual(rounded(bent({ ...LEG, range_deg: [-150, 190] }, foot)), [
    [20, 0],
    [-70, 180],
  ]);
});

test("where no posture leads there is a reason: too far, too near, or a joint's range", () => {
  const at = (r, z) => bent(LEG, { r, z }).unreached;
  assert.deepEqual(at(15 + 140 + 3, 0), { why: "far", by_mm: 3 });
  const uneven = { ...LEG, lengths_mm: [15, 70, 100] };
  assert.deepEqual(bent(uneven, { r: 15, z: 10 }).unreached, { why: "near", by_mm: 20 });
  // Straight toward the body 1st would have to turn by 180 degrees.
  const back = at(15 - 140, 0);
  assert.deepEqual([back.why, back.level], ["range", 1]);
  const stiff = { ...LEG, range_deg: [-60, 60] };
  const folded = inverse(stiff, points(stiff, [80, 0, 0])[3]).unreached;
  assert.deepEqual([folded.why, folded.level, Math.round(folded.angle_deg)], ["range", 0, 80]);
});

test("special places have an answer too: stretched, folded, above the root hinge", () => {
  assert.deepEqual(bent(LEG, { r: 155, z: 0 }).postures, [[0, 90]]);
  const folded = bent(LEG, { r: 15, z: 0 });
  for (const one of folded.postures) assert.ok(Math.abs(spots(LEG, ...one)[2].r - 15) < 1e-9);
  const above = inverse(LEG, [LEG.position_mm[0], LEG.position_mm[1], -110]);
  assert.ok(above.postures.length > 0);
  for (const one of above.postures) {
    assert.ok(apart(points(LEG, one)[3], [LEG.position_mm[0], LEG.position_mm[1], -110]) < 1e-6);
  }
});

test("a foot that stands moves the body by the chord of its swing", () => {
  const [from, to] = [22.5, -22.5].map((root) => points(LEG, [root, 20, 0])[3]);
  assert.ok(Math.abs(bodyWay(spots(LEG, 20, 0)[2].r, 45) - apart(from, to)) < 1e-9);
});

test("the middle is inside of a triangle, outside of it, or there is no triangle", () => {
  const square = [
    [50, 50],
    [-50, 50],
    [-50, -50],
    [50, -50],
  ];
  assert.equal(margin(square), 50);
  assert.equal(margin(square.slice(0, 2)), null);
  assert.equal(margin(square, [50, 0]), 0);
  assert.equal(margin(square, [80, 90]), -50);
  const right = [0, 1, 2].map((leg) => points(HEXAPOD[leg], [0, 20, 0])[3].slice(0, 2));
  assert.equal(margin(right), null);
});

test("each question of the lesson has one right answer, and different answers", () => {
  for (const robot of Object.values(SAMPLES)) {
    for (const step of lesson(robot)) {
      for (const { choices } of step.questions) {
        assert.equal(choices.filter(({ right }) => right).length, 1);
        const said = new Set(choices.map(({ say }) => JSON.stringify(say)));
        assert.equal(said.size, choices.length, JSON.stringify(choices));
      }
    }
  }
});
