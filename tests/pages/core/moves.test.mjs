// Tests of what the keys of the page's own robot do (client/web/src/core/moves.ts).

import assert from "node:assert/strict";
import { test } from "node:test";
import { effect, signal } from "../../../client/web/node_modules/@preact/signals/dist/signals.mjs";
import { movesOf } from "../../../client/web/src/core/moves.ts";
import { Phase } from "../../../client/web/src/core/wire.ts";

const ants = { team: "Ants", robot: "hexapod", keys: [[], [0, 1]], postures: [4, 4] };
const sheet = (match_id, seat = ants) => ({ match_id, seats: [seat] });
const health = (...moves) => ({ moves });

function watched(phase) {
  const court = {
    frame: signal({ phase }),
    health: signal(health(["still", "forward"])),
    sheet: signal(sheet("a")),
  };
  const own = signal(0);
  const found = movesOf(court, own);
  effect(() => void found.value);
  return { court, own, found };
}

for (const silent of [health([]), health(), health(["still"])])
  test(`a court that was restarted in the match takes no key's name away: ${JSON.stringify(silent)}`, () => {
    const { court, own, found } = watched(Phase.PLAYING);
    court.health.value = silent;
    assert.deepEqual(found.value, ["still", "forward"]);
    own.value = -1; // the page itself has lost its connection
    assert.deepEqual(found.value, []);
    own.value = 0;
    assert.deepEqual(found.value, ["still", "forward"]);
  });

for (const [change, next] of [
  ["match", sheet("b")],
  ["robot", sheet("a", { ...ants, robot: "quadruped" })],
  ["team", sheet("a", { ...ants, team: "Bees" })],
])
  test(`the names are not those of another ${change}`, () => {
    const { court, found } = watched(Phase.PLAYING);
    court.health.value = health([]);
    court.sheet.value = next;
    assert.deepEqual(found.value, []);
  });

test("before the match, when files can change, the newest word counts", () => {
  const { court, found } = watched(Phase.LOBBY);
  court.health.value = health([]);
  assert.deepEqual(found.value, []);
});
