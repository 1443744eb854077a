/** A match in pieces: which are asked for, and when what they have is shown. */

import assert from "node:assert/strict";
import { afterEach, beforeEach, describe, mock, test } from "node:test";
import { encode } from "../../../client/web/node_modules/@msgpack/msgpack/dist.esm/index.mjs";
import "./page.mjs";

const { Pieces } = await import("../../../client/web/src/core/pieces.ts");
const { MESSAGE_KINDS } = await import("../../../client/web/src/core/wire.gen.ts");

const STEP_MS = 50;
const fetched = globalThis.fetch;
let nowMs = 0;

/** Time goes on only in `pass`; other files' cases keep their clock. */
function ownClock() {
  mock.method(performance, "now", () => nowMs);
  mock.timers.enable({ apis: ["setTimeout"] });
  mock.method(Math, "random", () => 0.5);
}

function usualClock() {
  mock.timers.reset();
  mock.restoreAll();
  globalThis.fetch = fetched;
}

/** A gateway that closes a piece each second; each has its number in a message. */
class Gateway {
  constructor() {
    this.run = "one";
    this.beganMs = nowMs;
    this.room = false;
    this.down = false;
    this.asked = [];
    globalThis.fetch = (url) => this.answer(url);
  }

  get closed() {
    return Math.floor((nowMs - this.beganMs) / 1000);
  }

  async answer(url) {
    if (!url.endsWith("/here")) this.asked.push(url);
    if (this.down) throw new TypeError("nothing answers");
    const [run, number] = url.split("/").slice(-2);
    if (number === "now.json") {
      const { run, closed, room } = this;
      return { ok: true, status: 200, json: async () => ({ run, closed, room }) };
    }
    if (run !== this.run || Number(number) >= this.closed) return { ok: false, status: 404 };
    const said = (text) =>
      Uint8Array.of(MESSAGE_KINDS.indexOf("notice"), ...encode({ text: `${text} ${number}` }));
    const piece = encode([[said("start")], [[250, said("then")]]]);
    return { ok: true, status: 200, arrayBuffer: async () => piece };
  }
}

function watching(gateway) {
  const shown = { messages: [], begins: 0, rooms: 0 };
  const pieces = new Pieces("http://x/live/court", {
    take(messages, begins) {
      shown.begins += begins;
      for (const { dueMs, message } of messages)
        shown.messages.push({ text: message.body.text, dueMs, cameMs: nowMs });
    },
    room() {
      shown.rooms++;
    },
  });
  return { gateway, pieces, shown };
}

async function pass(ms) {
  for (const endMs = nowMs + ms; nowMs < endMs; ) {
    nowMs += STEP_MS;
    mock.timers.tick(STEP_MS);
    await new Promise((done) => setImmediate(done));
    await new Promise((done) => setImmediate(done));
  }
}

const numbers = (shown) =>
  shown.messages.filter(({ text }) => text.startsWith("then")).map(({ text }) => +text.slice(5));

describe("pieces", () => {
  beforeEach(ownClock);
  afterEach(usualClock);

  test("each piece is shown once, in its order, before its time and at most 4 s behind", async () => {
    const gateway = new Gateway();
    await pass(10_300);
    const { shown, pieces } = watching(gateway);
    await pass(60_000);
    pieces.end();
    const seen = numbers(shown);
    assert.deepEqual(
      seen,
      seen.map((_, index) => seen[0] + index),
    );
    assert.ok(seen.length >= 57);
    assert.equal(shown.begins, 1);
    assert.equal(shown.messages.filter(({ text }) => text.startsWith("start")).length, 1);
    for (const [index, { dueMs, cameMs }] of shown.messages.slice(2).entries()) {
      assert.ok(dueMs > cameMs + 250, "it came with time in hand");
      const wasMs = gateway.beganMs + 1000 * seen[index + 1] + 250;
      assert.ok(dueMs - wasMs > 1000 && dueMs - wasMs <= 4000, `${dueMs - wasMs} ms behind`);
    }
    assert.equal(gateway.asked.length, seen.length + 6, "a piece a second, and a look in ten");
  });

  test("a page that came first waits for two pieces", async () => {
    const { shown, pieces } = watching(new Gateway());
    await pass(5000);
    pieces.end();
    assert.deepEqual(numbers(shown).slice(0, 2), [0, 1]);
  });

  test("an answer that never comes does not hold the page up for ever", async () => {
    mock.method(AbortSignal, "timeout", (ms) => {
      const ending = new AbortController();
      setTimeout(() => ending.abort(new Error("too late")), ms);
      return ending.signal;
    });
    const gateway = new Gateway();
    await pass(5000);
    const { shown, pieces } = watching(gateway);
    await pass(5000);
    const { answer } = gateway;
    globalThis.fetch = (_, { signal }) =>
      new Promise((_, fail) => signal.addEventListener("abort", () => fail(signal.reason)));
    await pass(3000);
    globalThis.fetch = (url) => answer.call(gateway, url);
    const before = numbers(shown).length;
    await pass(25_000);
    pieces.end();
    assert.ok(numbers(shown).length > before);
  });

  test("with another run it begins again, and after an outage goes on", async () => {
    const gateway = new Gateway();
    await pass(5000);
    const { shown, pieces } = watching(gateway);
    await pass(5000);
    gateway.down = true;
    await pass(2500);
    gateway.down = false;
    await pass(5000);
    const before = numbers(shown);
    assert.deepEqual(
      before,
      [...new Set(before)].sort((a, b) => a - b),
    );
    assert.equal(shown.begins, 1);
    gateway.run = "two";
    gateway.beganMs = nowMs;
    await pass(6000);
    pieces.end();
    assert.equal(shown.begins, 2);
    assert.equal(numbers(shown)[before.length] <= 1 || numbers(shown).at(-1) < 6, true);
  });

  test("whoever fell far behind goes on near the newest piece", async () => {
    const gateway = new Gateway();
    await pass(5000);
    const { shown, pieces } = watching(gateway);
    await pass(3000);
    gateway.down = true;
    await pass(12_000);
    gateway.down = false;
    await pass(3000);
    pieces.end();
    assert.equal(shown.begins, 2);
    assert.ok(gateway.closed - numbers(shown).at(-1) <= 4);
  });

  test("it says that there is room only when there is room for a while", async () => {
    const gateway = new Gateway();
    await pass(5000);
    const { shown, pieces } = watching(gateway);
    gateway.room = true;
    await pass(11_000);
    assert.equal(shown.rooms, 0);
    await pass(20_000);
    assert.ok(shown.rooms > 0);
    pieces.end();
  });
});
