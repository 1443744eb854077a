// Tests of the pure parts of /office and /enter: timetable, places, files that are handed on.

import assert from "node:assert/strict";
import { test } from "node:test";
import { bySeat, gamesOf, pointsOf } from "../../../client/web/src/core/contest/games.ts";
import { places } from "../../../client/web/src/core/contest/places.ts";
import { meetAgain } from "../../../client/web/src/core/draw.ts";
import {
  canDecide,
  clockOf,
  columns,
  dropped,
  momentOf,
  teamsOfNext,
  wholeDay,
} from "../../../client/web/src/core/timetable.ts";

const slot = (pairing, court, at_ms, more = {}) => ({
  ...{ pairing, court, at_ms, teams: ["A", "B"], fixture: { code: "x" } },
  ...{ running: false, begun: false, moved: null, held: null, ...more },
});
const first = slot("s:a1.1", "north", 10, { running: true });
const second = slot("s:a1.2", "north", 20);
const third = slot("s:a1.3", "south", 5);

test("the next game is named by its teams, once both are known", () => {
  assert.equal(teamsOfNext([second, third]), "A – B");
  assert.equal(teamsOfNext([slot("s:f1.1", "north", 5, { teams: ["A", ""] }), second]), "");
  assert.equal(teamsOfNext([]), "");
});

test("a column has what its court plays, and then what it will play", () => {
  const view = {
    courts: [
      { court: "north", here: true },
      { court: "south", here: false },
    ],
    slots: [slot("s:a1.4", "north", 5), second, first, third],
  };
  const [north, south] = columns(view);
  assert.deepEqual(
    north.slots.map(({ pairing }) => pairing),
    ["s:a1.1", "s:a1.4", "s:a1.2"],
  );
  assert.deepEqual(south, { court: "south", here: false, slots: [third] });
});

test("a match that is dropped on another comes before it, unless that one is at a court", () => {
  const wish = { do: "move", pairing: "s:a1.3", court: "north", not_before_ms: 0 };
  assert.deepEqual(dropped(third, "north", second), { ...wish, before: "s:a1.2" });
  assert.deepEqual(dropped(third, "north", first), { ...wish, before: "" });
  assert.deepEqual(dropped(third, "north", null), { ...wish, before: "" });
  const later = slot("s:a1.3", "south", 5, { moved: { court: "", before: "", not_before_ms: 9 } });
  assert.equal(dropped(later, "north", null).not_before_ms, 9);
});

test("what changes nothing, and what has begun, is not moved", () => {
  assert.equal(dropped(second, "north", null), null);
  assert.equal(dropped(second, "north", second), null);
  assert.equal(dropped({ ...first, begun: true }, "south", null), null);
});

test("a match can be decided once both its teams are known", () => {
  assert.equal(canDecide(first), true);
  assert.equal(canDecide({ teams: ["", ""] }), false);
});

test("the day of a court has what it played, also at its end, and what it will play", () => {
  const game = (number, court, began_ms) => ({
    ...{ number, teams: ["A", "B"], scores: [number, 0], outcome: "left", court, began_ms },
  });
  const matches = [
    { pairing: { id: "s:a2.1" }, games: [game(1, "north", 9), game(2, "north", 7)] },
    { pairing: { id: "s:a2.2" }, games: [{ ...game(1), court: undefined, began_ms: undefined }] },
    { pairing: { id: "s:a2.3" } },
  ];
  const courts = [{ court: "north", here: true }];
  const sheet = { stages: [{ matches }] };
  const told = wholeDay({ courts, slots: [second] }, sheet).map(({ court, played, slots }) => [
    court,
    played.map(({ pairing, game, at_ms, scores }) => [pairing, game, at_ms, scores[0]]),
    slots.length,
  ]);
  assert.deepEqual(told, [
    [
      "north",
      [
        ["s:a2.1", 2, 7, 2],
        ["s:a2.1", 1, 9, 1],
      ],
      1,
    ],
    ["", [["s:a2.2", 1, 0, 1]], 0],
  ]);
});

test("a time of day is today's, or tomorrow's if today's was over half a day ago", () => {
  const noon = new Date(2030, 4, 1, 12, 0).getTime();
  const hour = 3_600_000;
  assert.equal(momentOf("", noon), 0);
  assert.equal(momentOf("13:30", noon), noon + 1.5 * hour);
  assert.equal(momentOf("11:00", noon), noon - hour);
  assert.equal(momentOf("00:30", new Date(2030, 4, 1, 23, 0).getTime()), noon + 12.5 * hour);
  assert.equal(clockOf(momentOf("09:05", noon)), "09:05");
  assert.equal(clockOf(0), "");
});

const row = (team, rank, out = false) => ({ team, rank, out });
const stage = (name, tables, matches = [], rounds_to_draw = 0) => ({
  ...{ stage: { name }, plan: {}, tables, matches, rounds_to_draw },
});
const match = (teams, state, loser = null, loser_place = null) => ({
  ...{ pairing: { id: "x:w1.1", loser_place }, teams, state, loser },
});

test("each team has the place of the last stage that it reached", () => {
  const groups = stage("groups", [
    { section: "a", rows: [row("A", 1), row("C", 2)] },
    { section: "b", rows: [row("B", 1), row("D", 2, true)] },
  ]);
  const final = stage("final", [{ section: "w", rows: [row("B", 1), row("A", 2)] }]);
  const sheet = { teams: [], planned: [], stages: [groups, final] };
  assert.deepEqual(
    places(sheet).map(({ team, rank, stage, group, won }) => [team, rank, stage, group, won]),
    [
      ["B", 1, "", "", true],
      ["A", 2, "", "", false],
      ["C", 2, "groups", "a", false],
    ],
  );
});

test("no team has a place in a bracket before it is out", () => {
  const open = stage(
    "final",
    [{ section: "w", rows: [row("A", 1), row("B", 1), row("C", 3)] }],
    [match(["A", "B"], "open"), match(["A", "C"], "decided", "C", 3)],
  );
  assert.deepEqual(
    places({ teams: [], planned: [], stages: [open] }).map(({ team }) => team),
    ["C"],
  );
});

test("who has left without a game has no place, but who was beaten has one", () => {
  const left = (name) => ({ name, withdrawn: true, disqualified: false });
  const played = { ...match(["A", "C"], "decided", "C", 2), games: [{ teams: ["A", "C"] }] };
  const over = stage(
    "final",
    [{ section: "w", rows: [row("A", 1), row("C", 2), row("E", 3)] }],
    [played],
  );
  const sheet = { teams: [left("C"), left("E")], planned: [], stages: [over] };
  assert.deepEqual(
    places(sheet).map(({ team }) => team),
    ["A", "C"],
  );
});

test("points of each game are in the order of the match's teams, whoever sat left", () => {
  const match = {
    teams: ["Eels", "Wasps"],
    games: [
      { number: 1, teams: ["Eels", "Wasps"], scores: [18, 12] },
      { number: 2, teams: ["Wasps", "Eels"], scores: [19, 17] },
    ],
    next_game: 3,
    next_seats: ["Wasps", "Eels"],
  };
  assert.deepEqual(gamesOf(match), [1, 2, 3]);
  assert.deepEqual(
    [1, 2, 3].map((number) => pointsOf(match, number)),
    [[18, 12], [17, 19], null],
  );
  assert.deepEqual(
    [1, 2, 3].map((number) => bySeat(match, number, [4, 5])),
    [
      [4, 5],
      [5, 4],
      [5, 4],
    ],
  );
  assert.deepEqual(gamesOf({ teams: ["Eels", "Wasps"] }), [1]);
  assert.deepEqual(bySeat({ teams: ["Eels", "Wasps"] }, 1, [4, 5]), [4, 5]);
});

test("who has met before and meets at once follows from the order of the draw", () => {
  const draw = {
    meet: [
      [0, 3],
      [1, 2],
    ],
    met: [
      ["A1", "A2"],
      ["B1", "B2"],
    ],
  };
  assert.deepEqual(meetAgain(draw, ["A1", "B1", "B2", "A2"]), [
    ["A1", "A2"],
    ["B1", "B2"],
  ]);
  assert.deepEqual(meetAgain(draw, ["A1", "B1", "A2", "B2"]), []);
  assert.deepEqual(meetAgain({ meet: [], met: [] }, ["A1", "B1"]), []);
});
