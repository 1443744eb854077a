// Tests of how a page gets the sheet of a contest (client/web/src/core/contest/feed.ts).

import assert from "node:assert/strict";
import { afterEach, mock, test } from "node:test";
import "./page.mjs";

const { Feed } = await import("../../../client/web/src/core/contest/feed.ts");
const { VERSION } = await import("../../../client/web/src/core/contest/sheet.ts");

const fetched = globalThis.fetch;

afterEach(() => {
  mock.timers.reset();
  globalThis.fetch = fetched;
});

/** Let time pass, and what waits for an answer go on. */
async function pass(ms) {
  mock.timers.tick(ms);
  for (let turn = 0; turn < 20; turn++) await Promise.resolve();
}

test("a newer sheet is shown no earlier than the picture of its match", async () => {
  mock.timers.enable({ apis: ["setTimeout"] });
  globalThis.window = globalThis;
  globalThis.document = { hidden: false, addEventListener() {}, removeEventListener() {} };
  let name = "before";
  globalThis.fetch = async () => ({
    ...{ ok: true, status: 200 },
    text: async () => JSON.stringify({ version: VERSION, name, stages: [], schedule: [] }),
  });
  const feed = new Feed();
  feed.behindMs = 20_000;
  const end = feed.start();
  await pass(0);
  assert.equal(feed.sheet.value?.name, "before", "the first one at once");
  name = "after";
  await pass(2000);
  await pass(19_000);
  assert.equal(feed.sheet.value.name, "before");
  await pass(1000);
  assert.equal(feed.sheet.value.name, "after");
  end();
});
