// Tests of the keys that a page has sent (client/web/src/core/sent_keys.ts).

import assert from "node:assert/strict";
import { test } from "node:test";
import { SentKeys } from "../../../client/web/src/core/sent_keys.ts";

const seat = (applied_seq, refused_seq = 0, refused_why = 0) => ({
  applied_seq,
  refused_seq,
  refused_why,
});

test("a key's time is from its press to the first frame that shows it", () => {
  const keys = new SentKeys();
  assert.equal(keys.add(1, 4, 1000), null);
  assert.equal(keys.see(seat(0), 1010), null);
  assert.equal(keys.see(seat(1), 1030), 30);
  assert.equal(keys.see(seat(1), 1050), null);
});

test("the frame that shows a key may come before the reply", () => {
  const keys = new SentKeys();
  assert.equal(keys.see(seat(1), 1030), null);
  assert.equal(keys.add(1, 4, 1000), 30);
});

test("a refused key is told once, also where its reply comes late", () => {
  const keys = new SentKeys();
  keys.add(1, 4, 1000);
  assert.equal(keys.refusal(seat(0)), null);
  assert.deepEqual(keys.refusal(seat(0, 1, 3)), { refused: 3, key: 4 });
  assert.equal(keys.refusal(seat(0, 1, 3)), null);
  assert.equal(keys.refusal(seat(0, 2, 5)), null);
  keys.add(2, 7, 1100);
  assert.deepEqual(keys.refusal(seat(0, 2, 5)), { refused: 5, key: 7 });
});

test("of thousands of keys only the newest are remembered", () => {
  const keys = new SentKeys();
  for (let seq = 1; seq <= 5000; seq++) {
    keys.add(seq, 1, seq);
    if (seq < 4000) keys.see(seat(seq), seq + 5);
  }
  assert.equal(keys.refusal(seat(0, 4000, 1)), null);
  assert.equal(keys.see(seat(5000), 5020), 20);
});
