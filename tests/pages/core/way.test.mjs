// Tests of where a team's page goes next (client/web/src/core/way.ts).

import assert from "node:assert/strict";
import { test } from "node:test";
import { Driver, nextMove, Return } from "../../../client/web/src/core/way.ts";

const called = { state: "court", court: "north", seat: "left", call: "c1" };
const waits = { state: "waits", court: "south", seat: "", call: "" };
const fresh = {
  ...{ there: waits, court: "north", call: "", seat: "", mine: "", seen: false },
  gone: false,
  driven: false,
};
const playing = { ...fresh, there: called, call: "c1", seat: "left", mine: "c1" };

const TABLE = [
  ["waits without a seat", fresh, "stay"],
  ["is called to this court", { ...fresh, there: called, call: "c1" }, "join"],
  [
    "is called, and its seat is driven by another page",
    { ...fresh, there: called, call: "c1", driven: true },
    "ask",
  ],
  ["drives its seat itself", { ...playing, mine: "", driven: true }, "hold"],
  ["is called, and the page does not see the match yet", { ...fresh, there: called }, "stay"],
  ["is called to another court", { ...fresh, there: { ...called, court: "south" } }, "go"],
  ["has joined", { ...playing, mine: "" }, "hold"],
  ["plays", playing, "stay"],
  ["has left, and comes back by a button", { ...playing, seat: "", gone: true }, "stay"],
  ["has no seat any more because the court refused it", { ...playing, seat: "" }, "join"],
  [
    "has left a match that is over, and the result was seen",
    { ...playing, there: waits, seat: "", gone: true, seen: true },
    "rest",
  ],
  ["has played, and the result is on the screen", { ...playing, there: waits }, "stay"],
  ["has played, and the result was seen", { ...playing, there: waits, seen: true }, "rest"],
  ["has played, and another match is open", { ...playing, there: waits, call: "c2" }, "rest"],
  ["was reloaded after its match", { ...playing, there: waits, mine: "", call: "c2" }, "rest"],
  [
    "is called to another court while the result is on the screen",
    { ...playing, there: { ...called, court: "south", call: "c2" } },
    "stay",
  ],
  [
    "is called to another court after that",
    { ...playing, there: { ...called, court: "south", call: "c2" }, seen: true },
    "go",
  ],
  [
    "keeps its seat in the next match of the court",
    { ...playing, there: { ...called, call: "c2" }, call: "c2" },
    "hold",
  ],
  [
    "has the other seat in the next match of the court",
    { ...playing, there: { ...called, seat: "right", call: "c2" }, call: "c2" },
    "join",
  ],
  ["has lost its seat to another window", { ...playing, seat: "", gone: true }, "stay"],
  [
    "has lost its seat because the office took the match back",
    { ...playing, there: waits, call: "c2", seat: "", gone: true },
    "rest",
  ],
  ["is out", { ...fresh, there: { ...waits, state: "out" } }, "stay"],
];

for (const [name, situation, move] of TABLE) {
  test(`a team that ${name}: ${move}`, () => assert.equal(nextMove(situation), move));
}

test("who drives a seat is not forgotten in a short silence, nor for another call", () => {
  const driver = new Driver();
  assert.equal(driver.drives("c1", 0), false);
  driver.heard("c1", 1000);
  assert.equal(driver.drives("c1", 10_900), true);
  assert.equal(driver.drives("c1", 11_000), false);
  assert.equal(driver.drives("c2", 1500), false);
});

const health = (session, heard_ms) => ({ seats: [{ id: "left", session, heard_ms }] });

for (const [name, mine, looks, found] of [
  ["knows no session", 0, [[health(7, 20), 0]], "ask"],
  ["has heard nothing of the court yet", 5, [[null, 0]], "wait"],
  ["still holds it", 5, [[health(5, 20), 0]], "ask"],
  ["finds it free, because the court was restarted", 5, [[health(0, null), 0]], "ask"],
  ["finds somebody who is silent", 5, [[health(7, 2000), 0]], "wait"],
  [
    "finds that nobody is heard",
    5,
    [
      [health(7, 2000), 0],
      [health(7, 5000), 3000],
    ],
    "ask",
  ],
  [
    "finds somebody who may be its own gateway",
    5,
    [
      [health(7, 20), 0],
      [health(7, 20), 2900],
    ],
    "wait",
  ],
  [
    "finds somebody who stutters",
    5,
    [
      [health(7, 20), 0],
      [health(7, 1600), 2500],
      [health(7, 20), 3000],
    ],
    "yield",
  ],
  [
    "finds that this one fell silent",
    5,
    [
      [health(7, 20), 0],
      [health(7, 1600), 2500],
      [health(7, 3100), 3000],
    ],
    "ask",
  ],
  [
    "finds somebody who drives",
    5,
    [
      [null, 0],
      [health(7, 20), 500],
      [health(7, 20), 3500],
    ],
    "yield",
  ],
]) {
  test(`a page that comes back to its seat and ${name}: ${found}`, () => {
    const coming = new Return();
    const all = looks.map(([seen, nowMs]) => coming.look(seen, "left", mine, nowMs));
    assert.equal(all.at(-1), found);
  });
}

test("a page that has yielded looks as long again when it comes back once more", () => {
  const coming = new Return();
  const look = (nowMs) => coming.look(health(7, 20), "left", 5, nowMs);
  assert.deepEqual([0, 3000, 60_000, 62_900, 63_000].map(look), [
    ...["wait", "yield", "wait", "wait", "yield"],
  ]);
  assert.equal(look(90_000), "wait");
  assert.equal(coming.look(null, "left", 5, 92_000), "wait", "another break");
  assert.equal(look(93_000), "wait");
});
