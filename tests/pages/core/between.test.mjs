// Tests of what is between two matches of an event (client/web/src/core/between.ts).

import assert from "node:assert/strict";
import { test } from "node:test";
import { signal } from "../../../client/web/node_modules/@preact/signals/dist/signals.mjs";
import { Between } from "../../../client/web/src/core/between.ts";
import { Phase } from "../../../client/web/src/core/wire.ts";

/** A court of an event with a match in a phase; `sheet` and `desk` are as the event's. */
function courtIn(phase, { call = "c1", desk = true } = {}) {
  return {
    frame: signal({ match: 1, phase }),
    sheet: signal({ fixture: { code: "fixture.final" }, call }),
    begun: signal(true),
    welcome: signal({ desk }),
    programme: signal(null),
  };
}

const shown = (phase, options) => {
  const court = courtIn(phase, options);
  return { court, between: new Between(court, court) };
};

test("between two matches a court waits in the lobby without a call", () => {
  assert.ok(shown(Phase.LOBBY, { call: "" }).between.isOn.value);
  assert.ok(!shown(Phase.LOBBY).between.isOn.value);
  assert.ok(!shown(Phase.PLAYING).between.isOn.value);
  const { court, between } = shown(Phase.LOBBY, { call: "" });
  court.begun.value = false;
  assert.ok(!between.isOn.value);
});

test("a result that was read gives way to what comes next, until the next match is here", () => {
  const { court, between } = shown(Phase.FINISHED);
  assert.ok(!between.isRead.value && !between.isOn.value);
  between.begin();
  assert.ok(between.isRead.value && between.isOn.value);
  court.frame.value = { match: 1, phase: Phase.OFFICIAL };
  assert.ok(between.isOn.value);
  court.frame.value = { match: 2, phase: Phase.LOBBY };
  assert.ok(!between.isRead.value && !between.isOn.value);
  court.frame.value = { match: 2, phase: Phase.OFFICIAL };
  assert.ok(!between.isRead.value);
});

test("without an office nothing comes in the place of a result that was read", () => {
  const { between } = shown(Phase.OFFICIAL, { desk: false });
  between.begin();
  assert.ok(between.isRead.value && !between.isOn.value);
});

test("the director's cut to another court shows that court's result", () => {
  const { court, between } = shown(Phase.OFFICIAL);
  court.programme.value = { court: "north" };
  between.begin();
  court.programme.value = { court: "south" };
  assert.ok(!between.isRead.value);
});

test("a stream takes a final result as read after some time", (context) => {
  context.mock.timers.enable({ apis: ["setTimeout"] });
  const { court, between } = shown(Phase.FINISHED);
  between.beginAfter(15_000);
  context.mock.timers.tick(60_000);
  assert.ok(!between.isOn.value, "the referee still confirms it");
  court.frame.value = { match: 1, phase: Phase.OFFICIAL };
  context.mock.timers.tick(14_000);
  assert.ok(!between.isOn.value);
  context.mock.timers.tick(1000);
  assert.ok(between.isOn.value);
});

test("each final result to which the director cuts is shown for this time", (context) => {
  context.mock.timers.enable({ apis: ["setTimeout"] });
  const { court, between } = shown(Phase.OFFICIAL);
  between.beginAfter(15_000);
  context.mock.timers.tick(10_000);
  court.programme.value = { court: "south" };
  context.mock.timers.tick(14_000);
  assert.ok(!between.isRead.value, "not for the rest of the first one's time");
  context.mock.timers.tick(1000);
  assert.ok(between.isRead.value);
  court.programme.value = { court: "north" };
  context.mock.timers.tick(15_000);
  assert.ok(between.isRead.value, "nor for ever");
});
