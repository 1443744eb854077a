// Tests of clocks and hints in words (client/web/src/i18n/words.ts).

import assert from "node:assert/strict";
import { readFileSync } from "node:fs";
import { test } from "node:test";
import { borderOf, ownLabel } from "../../../client/web/src/core/border.ts";
import { toldEvents } from "../../../client/web/src/core/rulings.ts";
import { said, setWords, t } from "../../../client/web/src/i18n/index.ts";
import {
  clock,
  clockTicks,
  endOf,
  eventClock,
  hint,
  markerName,
  played,
  winnerOf,
} from "../../../client/web/src/i18n/words.ts";

const every = new URL("../../../client/web/src/i18n/texts/en/every.json", import.meta.url);
setWords(JSON.parse(readFileSync(every, "utf-8")));

const PLAYING = 4;
const seat = (team) => ({ id: team.toLowerCase(), team });
const sheet = { duration_s: 180, seats: [seat("Ants"), seat("Bees")] };
const practice = { duration_s: 0, seats: [seat("Ants")] };

test("an event has the time that the clock showed, which counts down", () => {
  assert.equal(eventClock({ clock_ticks: 0 }, sheet), "3:00.0");
  assert.equal(eventClock({ clock_ticks: 3120 }, sheet), "1:57.6");
  assert.equal(clock(clockTicks({ clock_ticks: 3120 }, sheet)), "1:58");
  assert.equal(eventClock({ clock_ticks: 9000 }, sheet), "0:00.0");
});

test("a pause is told to end when it is over, not in the minute before", () => {
  const at = (minutes, seconds) => new Date(2027, 2, 20, 21, minutes, seconds).getTime();
  assert.equal(endOf(at(25, 0)), "21:25");
  assert.equal(endOf(at(24, 10)), "21:25");
});

test("events have different times also where the referee gave more time than was played", () => {
  // 38 s were played, and 90 s are given: the clock shows 3:52.
  assert.equal(eventClock({ clock_ticks: 1900 - 4500 }, sheet), "3:52.0");
  assert.equal(eventClock({ clock_ticks: 1950 - 4500 }, sheet), "3:51.0");
});

test("without an end, an event has the time that was played", () => {
  assert.equal(eventClock({ clock_ticks: 3120 }, practice), "1:02.4");
});

test("what an office assigned is named beside the game, and that a court waits for it", () => {
  const final = { code: "fixture.final", values: { stage: null } };
  const waiting = { code: "fixture.waiting" };
  const game = { ...sheet, title: "Robot-Othello", call: "", fixture: null };
  assert.equal(played(game), "Robot-Othello");
  assert.equal(played({ ...game, call: "c1", fixture: final }), "Final · Robot-Othello");
  assert.equal(played({ ...game, fixture: waiting }), "Robot-Othello");
  const frame = { value: { phase: 1, seats: [{ flags: 0 }, { flags: 0 }] } };
  const said = (fixture, sheet = game) =>
    hint({ frame, sheet: { value: { ...sheet, fixture } }, events: { value: [] } });
  assert.equal(said(waiting), "Waiting for the next match");
  assert.equal(said(null), "Waiting for Ants to join");
  const empty = { ...game, seats: [{ id: "left", team: "" }, seat("Bees")] };
  assert.equal(said(null, empty), "Waiting for the left seat to join");
});

test("who leads is told without a verb that depends on the name", () => {
  const leads = (left, right) => {
    const seats = [{ score: left }, { score: right }];
    const frame = { value: { phase: PLAYING, seats } };
    return hint({ frame, sheet: { value: sheet }, events: { value: [] } });
  };
  assert.equal(leads(20, 16), "Ants: ahead by 4");
  assert.equal(leads(16, 20), "Bees: ahead by 4");
  assert.equal(leads(18, 18), "Tied");
});

test("phases are words, and not the names that a program uses", () => {
  const why = { code: "over.time" };
  const names = ["lobby", "ready", "countdown", "playing", "halted", "official", "void"];
  const phrases = names.map((phase) => ({ code: `event.${phase}` }));
  for (const phrase of [...phrases, { code: "event.finished", values: { why } }]) {
    assert.match(said(phrase), /^(The|All|Play) [a-z].*\.$/);
  }
  for (let number = 0; number <= 8; number++) {
    assert.match(t(`phase.${number}`), /^[A-Z][a-z]+$/);
  }
});

test("the winner is whom the referee declares, and else the newest by the rules", () => {
  const result = (winner) => ({ kind: "result", data: { winner } });
  const declare = (winner) => ({
    kind: "decision",
    data: { decision: "declare", arguments: { winner } },
  });
  const winner = (...events) => winnerOf({ events: { value: events } });
  assert.equal(winner(), null);
  assert.equal(winner(result("left"), result("draw")), "draw");
  assert.equal(winner(result("left"), declare("right"), result("left")), "right");
  assert.equal(winner(declare("right"), declare("draw")), "draw");
});

test("a marker is shown by a word, and not by its name in the record", () => {
  assert.equal(markerName("flag7"), "flag 7");
  assert.equal(markerName("corner2"), "corner 2");
  assert.equal(markerName("c2r3"), "disc C4");
  assert.equal(markerName("line"), "line");
});

test("the border names columns and rows of discs; corners and flags have numbers", () => {
  const at = (name, x_m, y_m) => ({ name, kind: "", x_m, y_m, radius_m: 0.1, points: 1 });
  const discs = [at("c0r0", -1, -2), at("c1r0", 1, -2), at("c0r1", -1, 2)];
  assert.deepEqual(borderOf(discs), {
    columns: [
      ["A", -1],
      ["B", 1],
    ],
    rows: [
      ["1", -2],
      ["2", 2],
    ],
  });
  assert.deepEqual(discs.map(ownLabel), ["", "", ""]);
  const flags = [at("corner0", 0, 0), at("flag16", 1, 1), at("line", 0, 0)];
  assert.deepEqual(flags.map(ownLabel), ["0", "16", ""]);
  assert.deepEqual(borderOf(flags), { columns: [], rows: [] });
});

test("once the result is official, advice and who comes and goes are no news", () => {
  const advice = { number: 1, kind: "advice", data: {} };
  const lost = { number: 2, kind: "silent", data: {} };
  const official = { number: 3, kind: "phase", data: { after: "OFFICIAL" } };
  const gone = { number: 4, kind: "silent", data: {} };
  const next = { number: 5, kind: "decision", data: { decision: "next" } };
  assert.deepEqual(toldEvents([advice, lost]), [advice, lost]);
  assert.deepEqual(toldEvents([advice, lost, official, gone, next]), [lost, official, next]);
});
