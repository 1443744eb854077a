// Tests of the timeline (client/web/src/core/timeline.ts): however irregularly frames arrive, the
// moments that it shows move evenly and are never old. Each case returns a list of its mistakes.

import assert from "node:assert/strict";
import { test } from "node:test";
import { Timeline } from "../../../client/web/src/core/timeline.ts";

const frame = (beat, match = 1) => ({ match, beat });

/** Plays frames of a court; `arrival` gives the time [ms] when a frame arrives, Infinity: never. */
function play({ ms, beatsPerMs = 0.05, arrival = (at) => at, timeline, quietMs = 3000 }) {
  const line = timeline ?? new Timeline();
  const trouble = [];
  const arrivals = [];
  for (let beat = 0; beat < ms * beatsPerMs; beat++) {
    const at = 1000 + arrival(beat / beatsPerMs, beat);
    if (Number.isFinite(at)) arrivals.push([at, beat]);
  }
  arrivals.sort((one, other) => one[0] - other[0] || one[1] - other[1]);
  let next = 0;
  let last = null;
  let worst = 0;
  let behind = 0;
  let frames = 0;
  for (let now = 1000; now < 1000 + ms; now += 1000 / 60) {
    for (; next < arrivals.length && arrivals[next][0] <= now; next++) {
      line.push(frame(arrivals[next][1]), arrivals[next][0]);
    }
    const moment = line.sample(now);
    if (!moment) continue;
    const { before, after, part, beat } = moment;
    if (!(part >= 0 && part <= 1)) trouble.push(`part ${part}`);
    if (beat < before.beat || beat > after.beat) trouble.push(`beat ${beat} not within`);
    if (last !== null && beat < last) trouble.push(`back from ${last} to ${beat}`);
    if (now > 1000 + quietMs) {
      const step = (beat - last) / ((1000 / 60) * beatsPerMs);
      worst = Math.max(worst, Math.abs(step - 1));
      behind = Math.max(behind, now - 1000 - beat / beatsPerMs);
      frames++;
    }
    last = beat;
  }
  return { line, trouble, worst, behind, last, frames };
}

const chance = (() => {
  let seed = 1;
  return () => {
    seed = (seed * 16807) % 2147483647;
    return seed / 2147483647;
  };
})();

function check(found, { uneven, behindMs }) {
  const { trouble, worst, behind } = found;
  if (worst > uneven) trouble.push(`uneven: a step is ${worst.toFixed(2)} off`);
  if (behind > behindMs) trouble.push(`${behind.toFixed(0)} ms behind`);
  return trouble;
}

const CASES = {
  even: () => check(play({ ms: 10000 }), { uneven: 0.1, behindMs: 50 }),
  jitter: () =>
    check(play({ ms: 20000, arrival: (at) => at + 15 * chance() }), {
      uneven: 0.25,
      behindMs: 80,
    }),
  // Three frames arrive at a time, as over a slow Wi-Fi.
  bursts: () =>
    check(play({ ms: 20000, arrival: (at) => Math.ceil(at / 60) * 60 }), {
      uneven: 0.3,
      behindMs: 150,
    }),
  // One frame in five is lost.
  gaps: () =>
    check(play({ ms: 20000, arrival: (at, beat) => (beat % 5 === 3 ? Infinity : at) }), {
      uneven: 0.25,
      behindMs: 80,
    }),
  speed4: () => {
    const found = play({ ms: 12000, beatsPerMs: 0.2, quietMs: 5000 });
    const { beatsPerMs } = found.line;
    if (Math.abs(beatsPerMs - 0.2) > 0.01) found.trouble.push(`rate ${beatsPerMs}`);
    return check(found, { uneven: 0.3, behindMs: 80 });
  },
  halfSpeed: () =>
    check(play({ ms: 16000, beatsPerMs: 0.025, quietMs: 6000 }), {
      uneven: 0.3,
      behindMs: 130,
    }),
  // A spectator gets 25 frames a second, one for every two beats.
  spectator: () =>
    check(play({ ms: 20000, arrival: (at, beat) => (beat % 2 ? Infinity : at + 10 * chance()) }), {
      uneven: 0.3,
      behindMs: 90,
    }),
  // Frames arrive, but nothing is drawn, because a hidden tab gets no animation frames.
  hidden: () => {
    const { line, trouble } = play({ ms: 4000 });
    for (let beat = 200; beat < 3200; beat++) line.push(frame(beat), 1000 + beat * 20);
    if (line.length > 100) trouble.push(`${line.length} frames kept`);
    const { beat } = line.sample(1000 + 3200 * 20);
    if (3200 - beat > 8) trouble.push(`${3200 - beat} beats behind after the pause`);
    return trouble;
  },
  // The whole page was frozen: nothing arrives for a minute, then everything at once.
  frozen: () => {
    const { line, trouble } = play({ ms: 4000 });
    const backMs = 1000 + 3200 * 20;
    for (let beat = 200; beat < 3200; beat++) line.push(frame(beat), backMs + beat * 0.005);
    let last = line.sample(backMs + 20).beat;
    if (3201 - last > 12) trouble.push(`${3201 - last} beats behind after the freeze`);
    for (let beat = 3201; beat < 3500; beat++) {
      line.push(frame(beat), 1000 + beat * 20);
      const now = line.sample(1000 + beat * 20 + 5).beat;
      if (now < last || now > beat) trouble.push(`at ${beat}: from ${last} to ${now}`);
      last = now;
    }
    if (Math.abs(line.beatsPerMs - 0.05) > 0.002) trouble.push(`rate ${line.beatsPerMs}`);
    if (3500 - last > 8) trouble.push(`${3500 - last} beats behind at the end`);
    return trouble;
  },
  // The court stands still for 5 s and then goes on from the same beat.
  stopped: () => {
    const { line, trouble } = play({ ms: 4000 });
    const held = line.sample(1000 + 4000 + 4900).beat;
    if (held !== line.newest.beat) trouble.push(`held at ${held}`);
    let last = held;
    for (let beat = 200; beat < 400; beat++) {
      const at = 1000 + 5000 + beat * 20;
      line.push(frame(beat), at);
      const now = line.sample(at + 5).beat;
      if (now < last) trouble.push(`back from ${last} to ${now}`);
      last = now;
    }
    if (399 - last > 5) trouble.push(`${399 - last} beats behind`);
    return trouble;
  },
  newMatch: () => {
    const { line, trouble } = play({ ms: 4000 });
    line.push(frame(3, 2), 5010);
    line.push(frame(4, 2), 5030);
    const { before, after } = line.sample(5031);
    if (before.match !== 2 || after.match !== 2) trouble.push("the old match is shown");
    if (line.length !== 2) trouble.push(`${line.length} frames kept`);
    return trouble;
  },
  beatGoesBack: () => {
    const { line, trouble } = play({ ms: 4000 });
    line.push(frame(150), 5010);
    const { before } = line.sample(5012);
    if (before.beat !== 150) trouble.push(`${before.beat} is shown`);
    return trouble;
  },
  empty: () => (new Timeline().sample(5) === null ? [] : ["a moment of nothing"]),
  // A person has seen what is drawn, not what has come.
  seen: () => {
    const { line, trouble, last } = play({ ms: 4000 });
    const seen = line.seen(5010);
    if (seen.match !== 1 || seen.beat !== Math.floor(last)) trouble.push(`${seen.beat} of ${last}`);
    if (new Timeline().seen(5) !== null) trouble.push("a frame of nothing");
    line.push(frame(3, 2), 5011);
    if (line.seen(5012).match !== 2 || line.seen(5012).beat !== 3) trouble.push("the old match");
    return trouble;
  },
  // Frames come to a hidden tab, but nothing is drawn: it seems as near as before.
  seenWhileHidden: () => {
    const { line, trouble } = play({ ms: 4000, arrival: (at) => at + 15 * chance() });
    const behind = [];
    for (let beat = 200; beat < 3000; beat++) {
      const now = 1000 + beat * 20 + 15 * chance();
      line.push(frame(beat), now);
      if (beat % 5 === 0 && beat > 220) behind.push(beat - line.seen(now).beat);
      if (line.seen(now).beat > beat) trouble.push(`${beat} was not there`);
    }
    const [least, most] = [Math.min(...behind), Math.max(...behind)];
    if (least < 1 || most > 4) trouble.push(`from ${least} to ${most} beats behind`);
    return trouble;
  },
};

for (const [name, troubleOf] of Object.entries(CASES)) {
  test(`timeline: ${name}`, () => assert.deepEqual(troubleOf(), []));
}
