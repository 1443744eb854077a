// Tests of a page's claim to a seat (client/web/src/core/claim.ts), event by event.

import assert from "node:assert/strict";
import { test } from "node:test";
import {
  claimOf,
  isFinal,
  keptWish,
  step,
  TRANSITIONS,
} from "../../../client/web/src/core/claim.ts";

const wish = { court: "main", seat: "left", token: "abc", name: "Ants" };
const other = { ...wish, seat: "right" };
const busy = { why: { code: "refused.match-on" }, mistakes: [], again: true };
const no = { why: { code: "court.nobody" }, mistakes: [], again: false };
const wrongToken = { why: { code: "refused.wrong-token" }, mistakes: [], again: false };
const badFile = { why: { code: "refused.mistakes" }, mistakes: [{}], again: false };

const join = { is: "join", wish };
const change = { is: "change", renews: false };
const renew = { is: "change", renews: true };
const leave = { is: "leave" };
const forget = { is: "forget" };
const open = { is: "open" };
const granted = { is: "granted", wish, index: 0 };
const broke = { is: "failed", wish, refusal: no, broke: true };
const failed = (refusal) => ({ is: "failed", wish, refusal, broke: false });
const rested = { is: "rested" };
const taken = { is: "taken", why: { code: "hold.replaced" } };
const released = { is: "released" };
const kept = { is: "kept" };

const EVENTS = [join, change, renew, leave, forget, open, granted, broke, rested, taken, released]
  .concat([kept, ...[busy, no, wrongToken, badFile].map(failed)])
  .concat({ is: "mended" }, { is: "join", wish: other });

/** Returns the claim after some events, with the effects of the last event. */
function after(claim, ...events) {
  let effects = [];
  for (const event of events) [claim, effects] = step(claim, event);
  return { ...claim, effects };
}

const fresh = claimOf(null);
const reloaded = claimOf(wish);
const seated = after(fresh, join, open, granted);

/** Returns every step that events can lead to: claim, event, next claim and effects. */
function reachable() {
  const found = new Map();
  const steps = [];
  const waiting = [fresh, reloaded];
  while (waiting.length) {
    const claim = waiting.pop();
    const key = JSON.stringify(claim);
    // Tries are counted without end; claims with up to nine of them reach every state.
    if (found.has(key) || claim.tries > 9) continue;
    found.set(key, claim);
    for (const event of EVENTS) {
      const [next, effects] = step(claim, event);
      steps.push({ claim, event, next, effects });
      waiting.push(next);
    }
  }
  return steps;
}

test("mistakes of files are forgotten once other files are chosen, other refusals are not", () => {
  const refused = after(fresh, join, open, failed(badFile));
  assert.equal(refused.refusal, badFile);
  assert.equal(after(refused, { is: "mended" }).refusal, null);
  const unknown = after(fresh, join, open, failed(wrongToken));
  assert.equal(after(unknown, { is: "mended" }).refusal, wrongToken);
});

test("in every reachable state wish, reason, request and effects agree", () => {
  const steps = reachable();
  const states = new Set(steps.map(({ next }) => next.state));
  assert.deepEqual(states, new Set(Object.keys(TRANSITIONS)));
  for (const one of steps) {
    try {
      checkStep(one);
    } catch (error) {
      error.message += `\nin ${JSON.stringify(one)}`;
      throw error;
    }
  }
});

function checkStep({ claim, event, next, effects }) {
  const wants = ["joining", "holding", "changing", "leaving"].includes(next.state);
  assert.equal(next.wish !== null, wants);
  assert.equal(next.why !== null, next.state === "lost");
  if (keptWish(next)) assert.ok(["holding", "changing"].includes(next.state));
  if (effects.includes("ask")) {
    assert.equal(claim.request, "none"); // never two joins at once
    assert.equal(next.request, "sent");
    assert.ok(["joining", "holding", "changing"].includes(next.state));
  }
  if (event.is === "failed" || event.is === "granted") assert.notEqual(next.request, "sent");
  if (event.is === "rested") assert.equal(next.request, "none");
  // In every state, a person's request to join begins a join.
  if (event.is === "join") assert.deepEqual([next.state, next.wish], ["joining", event.wish]);
}

test("a first join is asked for once there is a court, and granted", () => {
  assert.deepEqual(after(fresh, join).effects, []);
  const asked = after(fresh, join, open);
  assert.deepEqual([asked.state, asked.request, asked.effects], ["joining", "sent", ["ask"]]);
  assert.equal(keptWish(asked), null);
  assert.deepEqual([seated.state, seated.request, seated.effects], ["holding", "none", ["begin"]]);
  assert.equal(keptWish(seated), wish);
});

for (const refusal of [busy, no, wrongToken, badFile]) {
  test(`a first join that is refused is shown at once: ${refusal.why.code}`, () => {
    const refused = after(fresh, join, open, failed(refusal));
    assert.deepEqual([refused.state, refused.effects], ["none", ["drop"]]);
    assert.deepEqual([refused.refusal, refused.lastWish], [refusal, wish]);
    assert.equal(after(refused, join).refusal, null);
  });
}

test("a first join that the connection lost is asked again after a pause", () => {
  const resting = after(fresh, join, open, broke);
  assert.deepEqual(
    [resting.state, resting.request, resting.effects],
    ["joining", "resting", ["rest"]],
  );
  assert.deepEqual(after(resting, open).effects, []);
  assert.deepEqual(after(resting, rested, open).effects, ["ask"]);
});

test("a seat that was held is asked for again after a break or a reload, without a message", () => {
  for (const claim of [seated, reloaded]) {
    assert.deepEqual(after(claim, open).effects, ["ask"]);
    let mended = claim;
    for (let time = 0; time < 50; time++) mended = after(mended, open, failed(busy), rested);
    assert.deepEqual([mended.state, mended.refusal], ["holding", null]);
    for (let time = 0; time < 50; time++) mended = after(mended, open, broke, rested);
    assert.equal(mended.state, "holding");
  }
});

test("a held seat is given up after eight refusals that name no reason to wait", () => {
  let claim = reloaded;
  for (let time = 0; time < 7; time++) {
    claim = after(claim, open, failed(no));
    assert.deepEqual([claim.state, claim.effects], ["holding", ["rest"]]);
    claim = after(claim, rested);
  }
  // A grant sets the number of tries back to zero.
  assert.equal(after(claim, open, granted, open, failed(no)).state, "holding");
  const refused = after(claim, open, failed(no));
  assert.deepEqual([refused.state, refused.refusal, refused.effects], ["none", no, ["drop"]]);
});

for (const refusal of [wrongToken, badFile]) {
  test(`a held seat that is refused for good is shown: ${refusal.why.code}`, () => {
    const refused = after(reloaded, open, failed(refusal));
    assert.deepEqual([refused.state, refused.refusal], ["none", refusal]);
    assert.equal(keptWish(refused), null);
  });
}

test("new files are sent at once, and any refusal of them is shown", () => {
  assert.deepEqual(after(seated, change).effects, ["ask"]);
  assert.equal(after(seated, change, granted).state, "holding");
  for (const refusal of [busy, no, badFile]) {
    const refused = after(seated, change, failed(refusal));
    assert.deepEqual(
      [refused.state, refused.refusal, refused.effects],
      ["none", refusal, ["drop"]],
    );
  }
  // The tab keeps its wish for the seat until the court answers.
  assert.equal(keptWish(after(seated, change)), wish);
  // While a join waits for its answer, no second one is sent.
  assert.deepEqual(after(seated, open, change).effects, []);
  for (const event of [change, renew]) assert.equal(after(fresh, event).state, "none");
});

test("practice gives the seat up for new files, and asks for it again", () => {
  const renewing = after(seated, renew);
  assert.deepEqual([renewing.effects, renewing.request], [["renew"], "none"]);
  assert.deepEqual(after(renewing, open).effects, ["ask"]);
  assert.equal(after(renewing, open, failed(badFile)).refusal, badFile);
});

test("a seat that is given up is not asked for again", () => {
  const leaving = after(seated, leave);
  assert.deepEqual(leaving.effects, ["release"]);
  assert.equal(keptWish(leaving), null);
  assert.deepEqual(after(leaving, open).effects, []);
  const left = after(leaving, released);
  assert.deepEqual([left.state, left.lastWish, left.effects], ["left", wish, ["clear"]]);
  assert.equal(after(left, forget).state, "none");
  assert.equal(after(left, forget).lastWish, wish);
  // If the court refuses to release the seat, all is as before.
  assert.deepEqual([after(leaving, kept).state, keptWish(after(leaving, kept))], ["holding", wish]);
  // A grant that comes after the page has left does not bring the seat back.
  assert.deepEqual(after(seated, open, leave, granted).effects, []);
  assert.equal(after(seated, open, leave, granted, released).state, "left");
});

test("a lost seat is told, and only a person asks for it again", () => {
  const lost = after(seated, taken);
  assert.deepEqual([lost.state, lost.why, lost.lastWish], ["lost", taken.why, wish]);
  assert.deepEqual(after(lost, open).effects, []);
  // The news of the loss may come twice.
  assert.equal(after(lost, taken).lastWish, wish);
  assert.deepEqual([after(lost, forget).state, after(lost, forget).why], ["none", null]);
  assert.deepEqual(after(lost, join, open).effects, ["ask"]);
  assert.equal(after(seated, leave, taken, released).state, "lost");
});

test("a match that is taken back while its seat is asked for leaves nothing behind", () => {
  const asked = after(fresh, join, open);
  const forgotten = after(asked, forget);
  assert.deepEqual([forgotten.state, forgotten.wish], ["none", null]);
  assert.deepEqual(forgotten.effects, ["drop"]);
  // The gateway ended that seat with the match: its answer grants nothing, whenever it comes.
  assert.equal(after(forgotten, granted).state, "none");
  const again = after(forgotten, { is: "join", wish: other }, granted);
  assert.deepEqual([again.state, again.wish, again.request], ["joining", other, "none"]);
  assert.deepEqual(after(again, open).effects, ["ask"]);
  // Nor does it refuse anything.
  const refused = after(forgotten, { is: "join", wish: other }, failed(no));
  assert.deepEqual([refused.state, refused.refusal, refused.request], ["joining", null, "none"]);
  assert.equal(after(seated, leave, forget, released).state, "none");
});

test("which refusals are final", () => {
  assert.deepEqual([busy, no, wrongToken, badFile].map(isFinal), [false, false, true, true]);
  assert.ok(isFinal({ why: { code: "refused.files-too-large" }, mistakes: [] }));
});
