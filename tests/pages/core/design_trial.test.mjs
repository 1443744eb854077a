// Tests of trials, of what the 3D view shows of them, and of the parts of a robot
// (client/web/src/core/design/trial.ts, sources.ts, parts.ts, predict.ts), on a studio's real answers.

import assert from "node:assert/strict";
import { execFileSync } from "node:child_process";
import { test } from "node:test";
import { fileURLToPath } from "node:url";
import { decode } from "../../../client/web/node_modules/@msgpack/msgpack/dist.esm/index.mjs";
import { signal } from "../../../client/web/node_modules/@preact/signals/dist/signals.mjs";
import * as parts from "../../../client/web/src/core/design/parts.ts";
import { paceOf, verdict, wayOf } from "../../../client/web/src/core/design/predict.ts";
import { lowestM, Rest, source, trialSource } from "../../../client/web/src/core/design/sources.ts";
import * as t from "../../../client/web/src/core/design/trial.ts";
import { ForwardKinematics } from "../../../client/web/src/core/fk.ts";
import { hull } from "../../../client/web/src/core/hull.ts";
import { chanceOf } from "./design_sample.mjs";

const SCRIPT = fileURLToPath(new URL("design_replies.py", import.meta.url));
const written = execFileSync(process.env.PYTHON ?? "python", [SCRIPT], { maxBuffer: 1 << 24 });
const robots = Object.entries(decode(new Uint8Array(written))).map(([name, replies]) => {
  const [robot, reply] = replies.map((one) => decode(one));
  return {
    name,
    robot,
    reply,
    legs: robot.legs.length,
    trial: t.readTrial(reply, robot.legs.length),
  };
});

/** For each leg, the places of its three hinges and its tip [m, world]. */
function chains(scene, fk, legs) {
  return Array.from({ length: legs }, (_, leg) => {
    const bodies = parts.jointsOfLeg(leg, legs).map((id) => parts.bodyOf(scene, id));
    const hinges = bodies.map((body) => [...fk.pos.slice(3 * body, 3 * body + 3)]);
    // The shank hangs along -z of its frame, and its hinge is at one end of it.
    const { pos, size } = scene.geoms.find(({ body }) => body === bodies[2]);
    const [w, x, y, z] = fk.quat.slice(4 * bodies[2], 4 * bodies[2] + 4);
    const down = [-2 * (x * z + w * y), -2 * (y * z - w * x), 2 * (x * x + y * y) - 1];
    const length = -pos[2] + size[1] + size[0];
    return [...hinges, hinges[2].map((part, axis) => part + length * down[axis])];
  });
}

/** Runs a case for each robot. */
function each(name, check) {
  for (const one of robots) test(`${name}: ${one.name}`, () => check(one));
}

each("bars of feet have the duty factor that the studio counted", ({ reply, trial }) => {
  const bars = t.footBars(trial, reply.first, reply.end);
  const ticks = reply.end - reply.first;
  const duty = bars.map((runs) => runs.reduce((sum, { from, to }) => sum + to - from, 0) / ticks);
  for (const [leg, share] of duty.entries()) {
    assert.ok(Math.abs(share - reply.figures.duty[leg]) < 1e-9, `leg ${leg}: ${share}`);
  }
  for (const [leg, runs] of bars.entries()) {
    for (const { from, to } of runs) {
      assert.ok(t.isDown(trial, leg, from) && t.isDown(trial, leg, to - 1));
      assert.ok(from === reply.first || !t.isDown(trial, leg, from - 1));
      assert.ok(to === reply.end || !t.isDown(trial, leg, to));
    }
  }
});

each("runs of postures fill the trial, and a cycle begins a run", ({ reply, trial }) => {
  const runs = t.postureRuns(trial);
  assert.equal(runs[0].from, 0);
  assert.equal(runs.at(-1).to, trial.ticks);
  runs.slice(1).forEach(({ from }, index) => {
    assert.equal(from, runs[index].to);
  });
  for (const start of reply.starts) assert.ok(runs.some(({ from }) => from === start));
});

/** The support margin, computed from the edges of the polygon. */
function marginOf(corners, [x, y]) {
  const edges = corners.map((from, index) => [from, corners[(index + 1) % corners.length]]);
  const aparts = edges.map(([[ax, ay], [bx, by]]) => {
    const [dx, dy] = [bx - ax, by - ay];
    const along = ((x - ax) * dx + (y - ay) * dy) / (dx * dx + dy * dy || 1);
    const part = Math.min(1, Math.max(0, along));
    return Math.hypot(x - ax - part * dx, y - ay - part * dy);
  });
  const isInside = edges.every(
    ([[ax, ay], [bx, by]]) => (bx - ax) * (y - ay) - (by - ay) * (x - ax) >= 0,
  );
  return (corners.length > 2 && isInside ? 1 : -1) * Math.min(...aparts);
}

each("the polygon has the margin that the studio measured", ({ trial }) => {
  const stood = new Set();
  for (let tick = 0; tick < trial.ticks; tick++) {
    const { feet, corners, centre, marginM } = t.support(trial, tick);
    stood.add(feet.length);
    assert.equal(marginM === null, feet.length === 0);
    if (marginM !== null) assert.ok(Math.abs(marginOf(corners, centre) - marginM) < 1e-6);
  }
  assert.ok(stood.size > 2, "feet lift");
});

each("the path is as long as the speed says", ({ reply, trial }) => {
  const path = t.pathOf(trial);
  const [from, to] = [path[reply.first - 1], path[reply.end - 1]];
  const wayMm = 1000 * Math.hypot(to[0] - from[0], to[1] - from[1]);
  const figure = (name) => t.figure(reply.figures, name);
  const shouldMm = figure("seconds") * Math.hypot(figure("speed_mm_s"), figure("lateral_mm_s"));
  assert.ok(shouldMm > 20 && Math.abs(wayMm - shouldMm) < 0.01, `${wayMm} ${shouldMm}`);
  assert.equal(figure("duty"), null);
});

test("arrays may begin at any byte, and their lengths must fit the ticks", () => {
  const { reply, trial, legs } = robots[0];
  for (const offset of [1, 2, 3]) {
    const moved = new Uint8Array(reply.poses.length + offset);
    moved.set(reply.poses, offset);
    const again = t.readTrial({ ...reply, poses: moved.subarray(offset) }, legs);
    assert.deepEqual(again.poses, trial.poses);
  }
  assert.throws(() => t.readTrial({ ...reply, tip_m: reply.tip_m.subarray(4) }, legs), RangeError);
  assert.throws(() => t.readTrial(reply, legs - 1), RangeError);
});

test("a convex hull has the right corners", () => {
  const square = [
    [0, 0],
    [1, 0],
    [1, 1],
    [0, 1],
  ];
  const cases = [
    [[], []],
    [[[1, 2]], [[1, 2]]],
    [
      [
        [1, 2],
        [1, 2],
      ],
      [[1, 2]],
    ],
    [
      [
        [2, 2],
        [0, 0],
        [1, 1],
      ],
      [
        [0, 0],
        [2, 2],
      ],
    ],
    [[[0.5, 0.5], ...square, [1, 0.5]], square],
  ];
  for (const [points, corners] of cases) assert.deepEqual(hull(points), corners);
});

each("a robot at rest is level and touches the floor", ({ robot, trial }) => {
  const rest = new Rest(robot);
  const fk = new ForwardKinematics(robot.scene, [robot.start_deg.length]);
  const chance = chanceOf(3);
  for (let count = 0; count < 50; count++) {
    const cells = robot.ranges_deg.map(([low, high]) => low + (high - low) * chance());
    const poses = rest.poses(cells);
    assert.deepEqual([...poses.slice(3, 7)], [1, 0, 0, 0]);
    fk.update(poses);
    assert.ok(Math.abs(lowestM(robot.scene, fk)) < 1e-6);
    const tips = chains(robot.scene, fk, trial.legs).flat();
    assert.ok(Math.min(...tips.map(([, , z]) => z)) > -1e-6);
  }
  // Compare with the robot that stands in physics before a key is pressed; its servos yield a bit.
  const width = trial.poses.length / trial.ticks;
  const standing = trial.poses.subarray(24 * width, 25 * width);
  const stood = rest.poses(
    [...trial.commandedRad.subarray(0, width - 7)].map((rad) => rad / (Math.PI / 180)),
  );
  assert.ok(Math.abs(stood[2] - standing[2]) < 0.002, `${stood[2]} ${standing[2]}`);
  assert.deepEqual(rest.poses(robot.start_deg.map(() => "x")), rest.poses(robot.start_deg));
});

each("the lowest point of a scene is where physics says", ({ robot, trial }) => {
  const fk = new ForwardKinematics(robot.scene, [robot.start_deg.length]);
  const width = trial.poses.length / trial.ticks;
  for (let tick = 10; tick < trial.ticks; tick += 5) {
    fk.update(trial.poses.subarray(tick * width, (tick + 1) * width));
    const tipM = Math.min(...trial.tipM.subarray(tick * trial.legs, (tick + 1) * trial.legs));
    assert.ok(Math.abs(lowestM(robot.scene, fk) - tipM) < 5e-4);
  }
});

each("a view shows a trial at a tick, and a posture", ({ robot, trial }) => {
  const tick = signal(10.25);
  const trials = trialSource(robot, trial, tick);
  assert.equal(trials.sheet.value, robot.sheet);
  const { before, after, part, beat } = trials.sample(0);
  assert.deepEqual([before.beat, after.beat, part, beat], [10, 11, 0.25, 10.25]);
  const width = trial.poses.length / trial.ticks;
  const posesOf = (frame) => new Float32Array(frame.poses.slice().buffer);
  assert.deepEqual(posesOf(after), trial.poses.slice(11 * width, 12 * width));
  assert.equal(trials.sample(0).before, before);
  for (const [asked, shown] of [
    [-5, 0],
    [1e9, trial.ticks - 1],
  ]) {
    tick.value = asked;
    assert.equal(trials.sample(0).beat, shown);
  }
  const posture = signal({ cells: robot.start_deg });
  const postures = source(signal(robot), posture);
  const first = postures.sample(0);
  assert.equal(postures.sample(1), first);
  assert.deepEqual([...first.before.scene], [...robot.sheet.scene]);
  posture.value = { cells: robot.start_deg.with(0, 0).with(1, 10) };
  const second = postures.sample(2);
  assert.notEqual(second.before.beat, first.before.beat);
  assert.ok(Math.abs(posesOf(second.before)[8] - (10 * Math.PI) / 180) < 1e-6);
});

test("one source shows a posture, then a trial, then another robot", () => {
  const [one, other] = robots;
  const [robot, shown] = [signal(null), signal(null)];
  const view = source(robot, shown);
  assert.deepEqual([view.sheet.value, view.scene.value, view.sample(0)], [null, null, null]);
  robot.value = one.robot;
  shown.value = { cells: one.robot.start_deg };
  assert.equal(view.sample(0).before.poses.length, 4 * 25);
  shown.value = { trial: one.trial, tick: 3 };
  assert.equal(view.sample(0).beat, 3);
  robot.value = other.robot;
  shown.value = { cells: other.robot.start_deg };
  assert.equal(view.scene.value, other.robot.scene);
  assert.equal(view.sample(0).before.poses.length, 4 * 19);
  shown.value = { trial: { ...one.trial, ticks: 0 }, tick: 0 };
  assert.equal(view.sample(0), null);
});

each("each joint has its link, and turns what hangs on it", ({ robot, legs }) => {
  const { scene, start_deg } = robot;
  const fk = new ForwardKinematics(scene, [start_deg.length]);
  const at = (cells) => {
    fk.update([0, 0, 0, 1, 0, 0, 0, ...cells.map((deg) => (deg * Math.PI) / 180)]);
    return chains(scene, fk, legs).map((chain) => chain.flat());
  };
  const before = at(start_deg);
  for (const id of start_deg.keys()) {
    const body = parts.bodyOf(scene, id);
    assert.equal(parts.jointOf(scene, body), id);
    const after = at(start_deg.with(id, start_deg[id] + 10));
    const moved = before.flatMap((chain, leg) => {
      const first = chain.findIndex((part, index) => Math.abs(part - after[leg][index]) > 1e-9);
      return first < 0 ? [] : [[leg, Math.floor(first / 3)]];
    });
    // The joint's own hinge stays in its place; the next hinge, or the tip, moves first.
    assert.deepEqual(moved, [[id % legs, Math.floor(id / legs) + 1]]);
  }
  assert.equal(parts.bodyOf(scene, start_deg.length), -1);
  assert.equal(parts.jointOf(scene, 0), null);
  assert.deepEqual(parts.jointsOfLeg(1, legs), [1, 1 + legs, 1 + 2 * legs]);
});

const minus = (one, other) => one.map((part, axis) => part - other[axis]);
const dot = (one, other) => one.reduce((sum, part, axis) => sum + part * other[axis], 0);

/**
 * The distance between a ray and a part of the line from one point to another; Infinity if this part
 * is behind the eye.
 */
function apartOf(eye, ray, [from, to], first, last) {
  const aparts = Array.from({ length: 41 }, (_, index) => {
    const share = first + (index / 40) * (last - first);
    const way = minus(
      from.map((part, axis) => part + share * (to[axis] - part)),
      eye,
    );
    const along = dot(way, ray) / Math.hypot(...ray);
    return along > 0 ? Math.sqrt(Math.max(0, dot(way, way) - along * along)) : Infinity;
  });
  return Math.min(...aparts);
}

each("a ray finds the link that it hits", ({ robot, legs }) => {
  const { scene, start_deg } = robot;
  const fk = new ForwardKinematics(scene, [start_deg.length]);
  fk.update(new Rest(robot).poses(start_deg));
  const links = chains(scene, fk, legs);
  const linkOf = (id) => links[id % legs].slice(Math.floor(id / legs), Math.floor(id / legs) + 2);
  const radiusM = scene.geoms.find(({ body }) => body === parts.bodyOf(scene, 0)).size[0];
  const chance = chanceOf(5);
  const random = (size) => [0, 1, 2].map(() => size * (2 * chance() - 1));
  const found = new Set();
  for (let count = 0; count < 1500; count++) {
    const eye = random(1).map((part) => part + Math.sign(part) * 0.3);
    const ray = minus(random(0.15), eye);
    const id = parts.pickJoint(scene, fk, eye, ray, 0);
    // Root links are so short that they are hardly more than their round ends. So only the middle
    // parts of the other links must have been missed.
    if (id === null) {
      for (const other of start_deg.keys()) {
        const isMissed = apartOf(eye, ray, linkOf(other), 0.25, 0.75) > 0.9 * radiusM;
        assert.ok(other < legs || isMissed, `${other} was not found`);
      }
    } else {
      found.add(id);
      assert.ok(apartOf(eye, ray, linkOf(id), 0, 1) < 1.1 * radiusM, `${id} is not there`);
    }
  }
  assert.equal(found.size, start_deg.length);
  // Seen from outside, a leg hides the leg on the other side.
  for (const [leg, [, from, to]] of links.entries()) {
    const eye = [20 * to[0], 20 * to[1], to[2]];
    const middle = from.map((part, axis) => (part + to[axis]) / 2);
    assert.equal(parts.pickJoint(scene, fk, eye, minus(middle, eye), 0) % legs, leg);
  }
  assert.equal(parts.pickJoint(scene, fk, [0, 0, 1], [0, 0, 1]), null);
  const [x, y] = links[0].at(-1);
  const beside = [x + 0.02, y + 0.02, 1];
  assert.equal(parts.pickJoint(scene, fk, beside, [0, 0, -1], 0), null);
  assert.equal(parts.pickJoint(scene, fk, beside, [0, 0, -1], 0.03), 2 * legs);
});

test("guesses are compared with the figures of the trials", () => {
  const run = (speed_mm_s, drift_deg_s = 0) => ({ speed_mm_s, drift_deg_s });
  const paces = [
    [60, 70, "faster"],
    [60, 50, "slower"],
    [60, 62, "same"],
    [0, 2, "same"],
    [200, 208, "same"],
    [-50, -40, "faster"],
  ];
  for (const [before, after, pace] of paces) assert.equal(paceOf(run(before), run(after)), pace);
  const ways = [
    [0, "straight"],
    [3, "straight"],
    [-3.1, "right"],
    [3.1, "left"],
  ];
  for (const [drift, way] of ways) assert.equal(wayOf(run(0, drift)), way);
  assert.equal(paceOf({}, run(5)), null);
  assert.equal(wayOf({ drift_deg_s: null }), null);
  assert.deepEqual(verdict({ about: "pace", is: "faster" }, run(60), run(70)), {
    right: true,
    was: "faster",
  });
  assert.deepEqual(verdict({ about: "way", is: "left" }, null, run(70, -9)), {
    right: false,
    was: "right",
  });
  assert.equal(verdict({ about: "pace", is: "faster" }, null, run(70)), null);
});
