/** A live match some time behind. */

import assert from "node:assert/strict";
import { test } from "node:test";
import { signal } from "../../../client/web/node_modules/@preact/signals/dist/signals.mjs";
import { Rewind } from "../../../client/web/src/core/rewind.ts";

globalThis.requestAnimationFrame ??= () => 0;
globalThis.cancelAnimationFrame ??= () => undefined;

function live() {
  const match = {
    sheet: signal(null),
    scene: signal(null),
    frame: signal(null),
    events: signal([]),
    verdict: signal(null),
    sample: () => ({ beat: match.frame.value.beat }),
  };
  const frame = (beat, number = 1) => {
    match.frame.value = { match: number, beat };
  };
  return { match, frame, rewind: new Rewind(match) };
}

test("a live match is passed on", () => {
  const { match, frame, rewind } = live();
  frame(5);
  match.events.value = [{ number: 1, beat: 4 }];
  assert.equal(rewind.frame.value.beat, 5);
  assert.equal(rewind.events.value.length, 1);
  assert.deepEqual(rewind.sample(0), { beat: 5 });
});

test("who goes back sees what was, and only the events until then", () => {
  const { match, frame, rewind } = live();
  for (let beat = 0; beat <= 1000; beat += 2) frame(beat);
  match.events.value = [100, 480, 520].map((beat, number) => ({ number, beat }));
  rewind.skip(-10);
  assert.equal(rewind.isBack.value, true);
  assert.equal(rewind.frame.value.beat, 500);
  assert.equal(rewind.events.value.length, 2);
  assert.equal(rewind.behindS.value, 10);
  rewind.seek(501);
  const { before, after, part } = rewind.sample(0);
  assert.deepEqual([before.beat, after.beat, part], [500, 502, 0.5]);
  frame(1002);
  assert.equal(rewind.frame.value.beat, 500);
  rewind.skip(10);
  assert.equal(rewind.frame.value.beat, 1002);
  assert.equal(rewind.isBack.value, false);
});

test("nobody goes back before the first frame, or beyond the newest", () => {
  const { frame, rewind } = live();
  for (let beat = 300; beat <= 600; beat++) frame(beat);
  rewind.skip(-60);
  assert.equal(rewind.frame.value.beat, 300);
  rewind.skip(60);
  assert.equal(rewind.isBack.value, false);
  rewind.skip(10);
  assert.equal(rewind.isBack.value, false);
});

test("another match, or another court of the director, is shown live", () => {
  for (const [beat, number, court] of [
    [0, 2, "north"],
    [50, 1, "south"],
    [800, 1, "south"],
  ]) {
    const { match, frame, rewind } = live();
    match.sheet.value = { court: "north" };
    for (let passed = 100; passed <= 400; passed++) frame(passed);
    rewind.skip(-3);
    match.sheet.value = { court };
    frame(beat, number);
    assert.equal(rewind.isBack.value, false);
    assert.equal(rewind.frame.value.beat, beat);
    assert.equal(rewind.firstBeat, beat);
  }
});

test("a page keeps two minutes, however long a match lasts", () => {
  const { frame, rewind } = live();
  for (let beat = 0; beat <= 30_000; beat++) frame(beat);
  assert.ok(rewind.lastBeat - rewind.firstBeat <= 6600);
  rewind.skip(-110);
  const at = rewind.frame.value.beat;
  rewind.toggle();
  for (let beat = 30_001; beat <= 32_000; beat++) frame(beat);
  assert.ok(rewind.frame.value.beat > at);
  assert.equal(rewind.frame.value.beat, rewind.firstBeat);
});
