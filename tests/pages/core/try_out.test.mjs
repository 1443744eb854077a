/** Keys that are tried before a match: what is asked again, and what is given up. */

import assert from "node:assert/strict";
import { afterEach, beforeEach, describe, mock, test } from "node:test";
import {
  computed,
  signal,
} from "../../../client/web/node_modules/@preact/signals/dist/signals.mjs";
import "./page.mjs";

const { TryOut } = await import("../../../client/web/src/core/try_out.ts");
const { Refused, Unanswered } = await import("../../../client/web/src/core/connection.ts");
const { Phase } = await import("../../../client/web/src/core/wire.gen.ts");

const EVERY = 2;
let nowMs = 0;

/** A court that answers with pictures until a tick; `fails` are thrown first. */
class Court {
  constructor() {
    this.frame = signal({ phase: Phase.LOBBY, match: 1, beat: 9, seats: [] });
    this.seat = signal({ hold: "held", seat: "left" });
    this.sheet = signal({ match: 1, seats: [{ id: "left", robot: "Hexapod", legs: ["a"] }] });
    this.scene = signal(null);
    this.events = signal([]);
    this.asked = [];
    this.fails = [];
    this.stopsAt = Number.POSITIVE_INFINITY;
  }

  sample() {
    return null;
  }

  async ask(what, { keys, first, until }) {
    assert.equal(what, "try");
    this.asked.push({ keys: keys.map(([, , key]) => key), first, until });
    const fail = this.fails.shift();
    if (fail) throw fail;
    const poses = [];
    for (let tick = first; tick < Math.min(until, this.stopsAt); tick += EVERY)
      poses.push(new Uint8Array(40));
    return { first, every: EVERY, poses, scene: new Uint8Array(8), drawn: { bodies: [] } };
  }
}

function begun() {
  const court = new Court();
  const player = { index: signal(0), part: () => computed(() => false) };
  const said = [];
  return { court, said, tried: new TryOut(court, player, ({ code }) => said.push(code)) };
}

async function pass(ms, tried) {
  for (const endMs = nowMs + ms; nowMs < endMs; ) {
    nowMs += 20;
    mock.timers.tick(20);
    for (let turn = 0; turn < 4; turn++) await new Promise((done) => setImmediate(done));
    tried.sample(nowMs);
  }
}

const no = (code, Kind = Refused) => new Kind({ code });

describe("a try-out", () => {
  beforeEach(() => {
    mock.method(performance, "now", () => nowMs);
    mock.timers.enable({ apis: ["setTimeout"] });
  });
  afterEach(() => {
    mock.timers.reset();
    mock.restoreAll();
  });

  test("goes on after a break before the first answer", async () => {
    const { court, tried, said } = begun();
    court.fails = [1, 2, 3].map(() => no("page.not-connected"));
    court.fails.push(no("net.slow", Unanswered));
    await pass(9000, tried);
    assert.equal(tried.isOpen.value, true);
    assert.deepEqual(said, []);
  });

  test("keeps its keys when an answer is late, and asks again", async () => {
    const { court, tried, said } = begun();
    await pass(1500, tried);
    court.fails = [no("net.slow", Unanswered)];
    tried.press(1, 2);
    await pass(4000, tried);
    assert.equal(tried.standing.value.key, 2);
    assert.deepEqual(said, []);
    assert.deepEqual(court.asked.at(-1).keys, [2]);
  });

  test("gives up a key that is refused, with the pictures of its walk", async () => {
    const { court, tried, said } = begun();
    await pass(1500, tried);
    tried.press(1, 1);
    await pass(2000, tried);
    court.fails = [no("key.none")];
    tried.press(1, 9);
    const known = court.asked.filter(({ keys }) => keys.length === 2).at(-1)?.first ?? 0;
    await pass(2000, tried);
    assert.deepEqual(said, ["key.none"]);
    assert.equal(tried.standing.value.key, 1);
    const next = court.asked.findLast(({ keys }) => keys.length === 1);
    assert.ok(next.first >= known, "it goes on from where the refused key was pressed");
  });

  test("ends where physics stopped, and does not ask for what can't come", async () => {
    const { court, tried } = begun();
    await pass(1500, tried);
    court.stopsAt = 100;
    tried.press(1, 2);
    await pass(1000, tried);
    const before = court.asked.length;
    await pass(6000, tried);
    assert.equal(tried.standing.value, null, "it stands at its start again");
    assert.ok(court.asked.length - before <= 2, `${court.asked.length - before} questions`);
  });
});
