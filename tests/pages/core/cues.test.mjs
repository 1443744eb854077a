/** What a match sounds like. */

import assert from "node:assert/strict";
import { test } from "node:test";
import { cuesBetween, heardAt } from "../../../client/web/src/core/cues.ts";

const [COUNTDOWN, PLAYING, HALTED, FINISHED] = [3, 4, 5, 6];
const sheet = { duration_s: 180 };
const frame = (beat, phase, more = {}) => ({
  match: 1,
  beat,
  phase,
  countdown_beats: 0,
  clock_ticks: 0,
  seats: [{ score: 1 }, { score: 1 }],
  ...more,
});
const scored = (number, beat, seat) => ({ number, beat, seat, data: { points: 2, marker: "a" } });

function heard(frames, events = []) {
  let before = null;
  return frames.flatMap((one) => {
    const now = heardAt(one, sheet, events, before);
    const cues = cuesBetween(before, now, events);
    before = now;
    return cues.map(({ name, seat }) => (seat < 0 ? name : `${name} ${seat}`));
  });
}

test("each second before the start is counted, then it starts", () => {
  const counted = [100, 99, 51, 50, 49, 1].map((left, beat) =>
    frame(beat, COUNTDOWN, { countdown_beats: left }),
  );
  assert.deepEqual(heard([...counted, frame(6, PLAYING)]), ["count", "start"]);
});

test("points are heard once, of whoever scored, and what came before is not", () => {
  const events = [scored(1, 5, 0), scored(2, 12, 1), scored(3, 13, 0)];
  const frames = [10, 12, 13, 14].map((beat) => frame(beat, PLAYING));
  assert.deepEqual(heard(frames, events), ["score 1", "score 0"]);
});

test("a new leader is heard", () => {
  const score = (left, right) => ({ seats: [{ score: left }, { score: right }] });
  const frames = [score(2, 1), score(2, 2), score(2, 3), score(2, 4)].map((one, beat) =>
    frame(beat, PLAYING, one),
  );
  assert.deepEqual(heard(frames), ["lead 1"]);
});

test("the last ten seconds are counted", () => {
  const left = [600, 501, 500, 499, 451, 450].map((ticks, beat) =>
    frame(beat, PLAYING, { clock_ticks: 9000 - ticks }),
  );
  assert.deepEqual(heard(left), ["last", "last"]);
});

test("a halt and the end are heard, with the winner's side", () => {
  const won = { seats: [{ score: 3 }, { score: 1 }] };
  const frames = [frame(1, PLAYING), frame(2, HALTED), frame(3, PLAYING), frame(4, FINISHED, won)];
  assert.deepEqual(heard(frames), ["halt", "start", "end 0"]);
});

test("a leap in time, back or forth, is silent, and so is another match", () => {
  const events = [scored(1, 200, 0)];
  assert.deepEqual(heard([frame(10, PLAYING), frame(400, FINISHED)], events), []);
  assert.deepEqual(heard([frame(400, FINISHED), frame(10, PLAYING)], events), []);
  assert.deepEqual(heard([frame(10, PLAYING), { ...frame(11, HALTED), match: 2 }], events), []);
});
