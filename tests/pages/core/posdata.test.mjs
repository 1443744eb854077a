// Tests of which rows a page keeps for Pos-data.txt (client/web/src/core/posdata.ts).

import assert from "node:assert/strict";
import { test } from "node:test";
import { PosData, PosDataLog } from "../../../client/web/src/core/posdata.ts";
import { Walker } from "../../../client/web/src/core/walk.ts";

const PLAYING = 4;
const LEG_JOINTS = 3;
const scene = new Uint8Array(8);
const sheet = { scene, seats: [{ legs: ["L,F"] }, { legs: ["L,F"] }] };

/** A frame in which both robots stand at x = `x` [m], turned to the left by `yaw` [degrees]. */
function frame(beat, { x = 0, yaw = 0, match = 1 } = {}) {
  const half = (yaw * Math.PI) / 360;
  const pose = [x, 0, 0.1, Math.cos(half), 0, 0, Math.sin(half), ...Array(LEG_JOINTS).fill(0)];
  const poses = new Uint8Array(new Float32Array([...pose, ...pose]).buffer);
  return { match, beat, phase: PLAYING, clock_ticks: beat, poses, scene };
}

const rowsOf = (data) =>
  data
    .parts()
    .join("")
    .trimEnd()
    .split("\n")
    .slice(1)
    .map((row) => row.split("\t").map(Number));

test("of a long practice the newest rows are kept", () => {
  const data = new PosData(0, [LEG_JOINTS, LEG_JOINTS], 100);
  for (let beat = 0; beat < 250; beat++) data.add(frame(beat, { x: beat }));
  assert.ok(data.isCut);
  assert.equal(data.sinceTicks, 150);
  assert.deepEqual(
    rowsOf(data).map(([, x]) => x),
    Array.from({ length: 100 }, (_, index) => 150 + index),
  );
});

test("another seat and another match begin a new list", () => {
  const log = new PosDataLog();
  for (let beat = 0; beat < 5; beat++) log.add(frame(beat), 0, sheet);
  assert.equal(log.current.length, 5);
  log.add(frame(5), 1, sheet);
  assert.deepEqual([log.current.seat, log.current.length], [1, 1]);
  log.add(frame(6), 1, sheet);
  log.add(frame(0, { match: 2 }), 1, sheet);
  assert.equal(log.current.length, 1);
});

test("frames of a scene that the sheet does not name are left out", () => {
  const log = new PosDataLog();
  log.add({ ...frame(0), scene: new Uint8Array(8).fill(1) }, 0, sheet);
  assert.equal(log.current, null);
});

test("the heading on the page is the yaw in the file (rules 2)", () => {
  for (const yaw of [0, 90, 179, -45]) {
    const data = new PosData(0, [LEG_JOINTS, LEG_JOINTS]);
    data.add(frame(1, { yaw }));
    const [[, , , , , , written]] = rowsOf(data);
    assert.equal(Math.round(written), yaw);
    assert.equal(new Walker(0).look(frame(1, { yaw }), sheet, []).headingDegrees, yaw);
  }
});
