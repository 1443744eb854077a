// Tests of what a page knows of the referee's decisions (client/web/src/core/rulings.ts).

import assert from "node:assert/strict";
import { test } from "node:test";
import { canPlayAgain } from "../../../client/web/src/core/rulings.ts";

test("a rematch is advised only while the referee can still have one", () => {
  const no = { code: "why.phase" };
  assert.ok(canPlayAgain({ abort: null, next: no }), "the match can be declared void");
  assert.ok(canPlayAgain({ abort: no, next: null }), "the same teams can play another one");
  assert.ok(!canPlayAgain({ abort: no, next: { code: "why.office-opens-next" } }));
  assert.ok(!canPlayAgain({ abort: no, next: { code: "why.waits-for-office" } }));
});
