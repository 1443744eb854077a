// Tests of what the page's own robot would gain next (client/web/src/core/gains.ts).

import assert from "node:assert/strict";
import { test } from "node:test";
import { effect, signal } from "../../../client/web/node_modules/@preact/signals/dist/signals.mjs";
import { gainsOf } from "../../../client/web/src/core/gains.ts";
import { Phase } from "../../../client/web/src/core/wire.ts";

const gains = (points) => ({ said: { code: "gains.flags", values: {} }, points });
const health = (...seats) => ({ gains: seats });

function watched(index) {
  const court = { frame: signal({ phase: Phase.PLAYING }), health: signal(null) };
  const own = signal(index);
  const found = gainsOf(court, own);
  const seen = [];
  effect(() => {
    seen.push(found.value?.points ?? null);
  });
  return { court, own, seen };
}

test("a seat's gains change only when they do, though health comes twice a second", () => {
  const { court, seen } = watched(1);
  court.health.value = health(gains({ flag1: 2 }), gains({ flag2: 3 }));
  court.health.value = health(gains({}), gains({ flag2: 3 }));
  court.frame.value = { phase: Phase.PLAYING };
  court.health.value = health(gains({}), gains({ flag2: 3, flag4: 1 }));
  assert.deepEqual(seen, [null, { flag2: 3 }, { flag2: 3, flag4: 1 }]);
});

test("nothing is to be gained without a seat, or while no robot moves", () => {
  const { court, own, seen } = watched(0);
  court.health.value = health(gains({ corner0: 5 }));
  court.frame.value = { phase: Phase.HALTED };
  court.frame.value = { phase: Phase.COUNTDOWN };
  own.value = -1;
  court.health.value = health();
  assert.deepEqual(seen, [null, { corner0: 5 }, null, { corner0: 5 }, null]);
});
