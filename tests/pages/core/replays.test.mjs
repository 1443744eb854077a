/** Moments that are shown again in a pause. */

import assert from "node:assert/strict";
import { test } from "node:test";
import { signal } from "../../../client/web/node_modules/@preact/signals/dist/signals.mjs";
import { momentAgain, Replays } from "../../../client/web/src/core/replays.ts";
import { Phase } from "../../../client/web/src/core/wire.gen.ts";

globalThis.requestAnimationFrame ??= () => 0;
globalThis.cancelAnimationFrame ??= () => undefined;

const scored = (number, beat, points, seat = 0) => ({
  number,
  beat,
  seat,
  kind: "flipped",
  data: { points, marker: "m1" },
});

test("the largest moment since the last pause is shown, if its run-up is kept", () => {
  const events = [scored(1, 100, 9), scored(2, 400, 3), scored(3, 600, 5), scored(4, 700, 1)];
  assert.equal(momentAgain(events, 0, 0), events[2], "the first has no run-up");
  assert.equal(momentAgain(events, 0, 600), events[3]);
  assert.equal(momentAgain(events, 500, 0), events[3]);
  assert.equal(momentAgain([], 0, 0), null);
});

function live() {
  const match = {
    sheet: signal(null),
    scene: signal(null),
    frame: signal(null),
    events: signal([]),
    sample: () => ({ beat: match.frame.value.beat }),
  };
  return match;
}

test("in a pause the moment is shown once, and play or its end ends it", (context) => {
  context.mock.timers.enable({ apis: ["setInterval"] });
  const match = live();
  const replays = new Replays(match);
  let beat = 0;
  const pass = (beats, phase, fromMs) => {
    for (let step = 0; step < beats; step += 2) {
      beat += 2;
      match.frame.value = { match: 1, beat, phase };
      replays.look(fromMs + 20 * step);
    }
  };
  pass(1000, Phase.PLAYING, 0);
  match.events.value = [scored(1, 600, 4)];
  pass(100, Phase.HALTED, 20_000);
  assert.equal(replays.shown.value, null, "not at once");
  pass(100, Phase.HALTED, 22_000);
  assert.equal(replays.shown.value.number, 1);
  assert.equal(replays.rewind.beat.value, 450);
  assert.equal(replays.rewind.playback.speed.value, 0.5);
  replays.rewind.seek(650);
  replays.look(30_000);
  assert.equal(replays.shown.value, null);
  assert.equal(replays.rewind.isBack.value, false);
  pass(400, Phase.HALTED, 30_000);
  assert.equal(replays.shown.value, null, "not twice");

  pass(500, Phase.PLAYING, 40_000);
  match.events.value = [...match.events.value, scored(2, 1900, 1)];
  pass(200, Phase.HALTED, 60_000);
  assert.equal(replays.shown.value.number, 2);
  pass(10, Phase.COUNTDOWN, 70_000);
  assert.equal(replays.shown.value, null, "play goes on");
  assert.equal(replays.rewind.isBack.value, false);
});

test("whoever looks back by hand is left alone", (context) => {
  context.mock.timers.enable({ apis: ["setInterval"] });
  const match = live();
  const replays = new Replays(match);
  for (let beat = 0; beat <= 1000; beat += 2) match.frame.value = { match: 1, beat, phase: 3 };
  match.events.value = [scored(1, 600, 4)];
  replays.rewind.skip(-5);
  match.frame.value = { match: 1, beat: 1002, phase: Phase.HALTED };
  replays.look(0);
  replays.look(9000);
  assert.equal(replays.shown.value, null);
  assert.equal(replays.rewind.isBack.value, true);
});
