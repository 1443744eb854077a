// Tests of what is shown of a contest's sheet (client/web/src/core/contest).

import assert from "node:assert/strict";
import { execFileSync } from "node:child_process";
import { test } from "node:test";
import { fileURLToPath } from "node:url";
import { bracket } from "../../../client/web/src/core/contest/bracket.ts";
import { fit } from "../../../client/web/src/core/contest/fit.ts";
import * as g from "../../../client/web/src/core/contest/games.ts";
import { places, podium } from "../../../client/web/src/core/contest/places.ts";
import * as c from "../../../client/web/src/core/contest/sheet.ts";
import { slides } from "../../../client/web/src/core/contest/slides.ts";
import { Turns } from "../../../client/web/src/core/contest/turns.ts";
import { Cuts } from "../../../client/web/src/core/cuts.ts";
import { Phase } from "../../../client/web/src/core/wire.ts";

/** Sheets of contests with random results, made by Python. */
const SHEETS = JSON.parse(
  execFileSync(process.env.PYTHON ?? "python", ["-m", "tests.pages.core.contest_sheets"], {
    cwd: fileURLToPath(new URL("../../..", import.meta.url)),
    maxBuffer: 1 << 28,
  }),
);
const { groups, finals, single, double, swiss } = SHEETS;
const cup = (sheet) => sheet.stages.at(-1);

test("a contest is over when all its stages are, and then it has a winner", () => {
  assert.equal(c.stateOf(groups), "running");
  assert.deepEqual(c.champions(groups), []);
  assert.equal(c.currentStage(groups).stage.name, "groups");
  assert.equal(c.stateOf(finals), "over");
  assert.deepEqual(c.champions(finals), [cup(finals).tables[0].rows[0].team]);
  assert.equal(c.stateOf({ ...finals, stages: [] }), "waiting");
  assert.equal(c.stateOf({ ...finals, planned: [{ stage: "more" }] }), "running");
  const { done, all } = c.progress(finals);
  assert.equal(done, all);
});

test("teams that have left are named, and do not count", () => {
  const [one, two, three, four, ...others] = groups.teams;
  const replaced = { ...four, withdrawn: true, substitute: others[0].name };
  const teams = [
    { ...one, withdrawn: true },
    replaced,
    { ...two, disqualified: true },
    { ...three, withdrawn: true, disqualified: true },
    ...others,
  ];
  assert.deepEqual(c.teamsOf({ ...groups, teams }), {
    here: others.length,
    gone: [one.name],
    replaced: [replaced],
    expelled: [two.name, three.name],
  });
});

test("the next games are those on courts, then those that can be played", () => {
  const all = g.nextGames(groups, 99);
  assert.equal(all.length, groups.running.length + groups.coming.length);
  const courts = c.running(groups).map(({ court }) => court);
  assert.deepEqual(
    all.map(({ court }) => court),
    [...courts, ...groups.coming.map(() => "")],
  );
  assert.deepEqual(g.nextGames(groups, 1), all.slice(0, 1));
  assert.deepEqual(g.nextGames(finals, 3), []);
});

test("a final that waits for another match is among the next games once its teams are known", () => {
  const team = (name) => ({ code: "who.team", values: { team: name } });
  const place = { pairing: "cup:w2.1", stage: "cup", court: "east", at_ms: 60_000 };
  const known = { ...place, fixture: { code: "x" }, who: [team("Eels"), team("Ants")] };
  const unknown = { ...known, who: [team("Eels"), { code: "who.winner", values: {} }] };
  const sheet = { stages: [], running: [], coming: [], later: [known] };
  const [next] = g.nextGames(sheet, 4);
  assert.deepEqual([next.teams, next.court, next.at_ms], [["Eels", "Ants"], "east", 60_000]);
  assert.deepEqual(g.nextGames({ ...sheet, later: [unknown] }, 4), []);
});

test("the table ahead is the one that the next game may change; a bracket has none", () => {
  const [next] = g.nextGames(groups, 1);
  const { view, table } = g.tableAhead(groups);
  assert.equal(view.stage.name, "groups");
  for (const team of next.teams) assert.ok(table.rows.some((row) => row.team === team));
  assert.equal(g.tableAhead(finals), null, "over, and its last stage is a bracket");
  const [only] = finals.stages;
  const ended = g.tableAhead({ ...finals, running: [], coming: [], later: [], stages: [only] });
  assert.equal(ended.view, only, "after the last game");
  assert.equal(g.tableAhead(single), null);
});

test("rounds have the matches of all groups, and no byes in a bracket", () => {
  const view = groups.stages[0];
  const rounds = c.rounds(view);
  assert.deepEqual(
    rounds.map(({ round }) => round),
    [1, 2, 3],
  );
  for (const { matches } of rounds) {
    assert.deepEqual([...new Set(matches.map(({ pairing }) => pairing.section))], ["a", "b"]);
  }
  const [first] = c.rounds(cup(single));
  assert.equal(first.matches.length, 13 - 8); // 13 teams have 3 byes in a bracket of 16
  assert.ok(
    c.rounds(swiss.stages[0]).every(({ matches }) => matches.some((one) => !c.isMatch(one))),
  );
});

test("the match of a record is found by the games that were counted", () => {
  const match = {
    games: [
      { number: 1, record: "a.mcap" },
      { number: 2, record: "b.mcap" },
    ],
  };
  const sheet = { stages: [{ matches: [{}] }, { matches: [{ games: [{ number: 1 }] }, match] }] };
  assert.equal(g.matchOf(sheet, "b"), match);
  assert.equal(g.matchOf(sheet, "c"), null);
});

test("a score has points of the only game, or games won, by place", () => {
  for (const sheet of [groups, finals]) {
    for (const view of sheet.stages) {
      for (const match of view.matches.filter(({ how }) => how === "played")) {
        const [one, other] = c.score(match, view);
        if (match.winner === match.teams[0]) assert.ok(one > other);
        if (match.winner === match.teams[1]) assert.ok(one < other);
        if (!match.winner) assert.equal(one, other);
        assert.equal(c.countsGames(match, view), view === cup(finals));
      }
    }
  }
});

test("a drawn game is half a game for each, so two of them are a tie", () => {
  const teams = ["Ants", "Bees"];
  const game = (number, outcome) => ({ number, teams, scores: [3, 3], outcome });
  const view = { stage: { settings: { games: 3 } } };
  const score = (...outcomes) => {
    const games = outcomes.map((outcome, index) => game(index + 1, outcome));
    return c.score({ teams, games }, view).map(c.written);
  };
  assert.deepEqual(score("draw", "draw"), ["1", "1"]);
  assert.deepEqual(score("draw"), ["½", "½"]);
  assert.deepEqual(score("draw", "left"), ["1½", "½"]);
  assert.deepEqual(score("left", "void"), ["1", "0"]);
});

test("the next game of a team is the one after the call that was played", () => {
  const one = { pairing: "cup:w1.1", game: 1, teams: ["Ants", "Bees"], court: "east" };
  const two = { pairing: "cup:w2.1", game: 1, teams: ["Cats", "Ants"], court: "west", at_ms: 5 };
  const sheet = { stages: [], running: [{ ...one, id: "c1" }], coming: [two], later: [] };
  assert.equal(g.nextGameOf(sheet, "Ants", "c1").at_ms, 5);
  assert.equal(g.nextGameOf(sheet, "Bees", "c1"), null);
  assert.equal(g.nextGameOf(sheet, "Bees", "c0").court, "east");
});

test("a match says how it ended where its score does not", () => {
  const match = { state: "decided", how: "played", winner: "Ants" };
  assert.equal(c.howEnded(match), null);
  assert.equal(c.howEnded({ ...match, winner: "" }), "draw");
  assert.equal(c.howEnded({ ...match, how: "walkover" }), "walkover");
  assert.equal(c.howEnded({ ...match, how: "walkover", winner: "" }), "absent");
  assert.equal(c.howEnded({ ...match, how: "void", winner: "" }), "void");
  assert.equal(c.howEnded({ ...match, state: "open", how: "" }), null);
});

test("each team's way has all its matches, places and its rating", () => {
  for (const { name } of finals.teams) {
    const view = c.teamView(finals, name);
    const there = finals.stages.flatMap(({ matches }) => matches).filter(c.isMatch);
    const own = there.filter(({ teams }) => teams.includes(name));
    assert.deepEqual(
      view.matches.map(({ match }) => match),
      own,
    );
    assert.equal(view.ranks[0].row.team, name);
    assert.equal(finals.ratings[view.rated - 1].team, name);
  }
  assert.equal(c.teamView(finals, "nobody"), null);
});

for (const [name, sheet] of Object.entries({ finals, single, double })) {
  test(`no two boxes of a bracket overlap, and lines lead to the right (${name})`, () => {
    const { boxes, lines, columns, rows } = bracket(cup(sheet));
    assert.equal(boxes.length, cup(sheet).matches.filter(c.isMatch).length);
    for (const [index, one] of boxes.entries()) {
      assert.ok(one.row >= 0.5 && one.row <= rows - 0.5, `${one.row} of ${rows}`);
      assert.ok(one.column >= 0 && one.column < columns);
      for (const other of boxes.slice(index + 1)) {
        const apart = one.column !== other.column || Math.abs(one.row - other.row) >= 1;
        assert.ok(apart, `${one.match.pairing.id} ${other.match.pairing.id}`);
      }
    }
    for (const { from, to, place } of lines) {
      assert.ok(from.column < to.column);
      const winner = from.match.winner;
      if (winner) assert.equal(to.match.teams[place], winner);
    }
    // Every winner goes on, except in the last match, and where it decides a place.
    const ends = boxes.filter((box) => !lines.some(({ from }) => from === box));
    const sections = ends.map(({ match }) => match.pairing.section);
    assert.ok(sections.every((section) => "wpf".includes(section)) && ends.length <= 2);
  });
}

test("an empty place names the match before a bye", () => {
  const view = cup(double);
  const all = c.byId(view);
  for (const match of view.matches.filter(c.isMatch)) {
    for (const source of match.pairing.sources) {
      const from = c.origin(source, all);
      if (from.source === "winner") assert.ok(c.isMatch(all.get(from.pairing)));
    }
  }
});

test("slides show every row of a table once, and brackets in parts that can be read", () => {
  const shown = slides(swiss);
  assert.deepEqual(
    shown
      .flatMap((slide) => (slide.is === "tables" ? slide.parts : []))
      .flatMap(({ rows }) => rows),
    swiss.stages[0].tables[0].rows,
  );
  assert.deepEqual([shown[0].is, shown.at(-1).is], ["now", "ratings"]);
  for (const sheet of [finals, single, double]) {
    const cuts = slides(sheet).filter(({ is }) => is === "bracket");
    assert.ok(cuts.length >= 1);
    for (const { view, cut } of cuts) {
      const { rows, columns } = bracket(view, cut);
      assert.ok(rows <= 4 && columns <= 3);
    }
  }
  assert.equal(slides(finals)[0].is, "podium");
  const before = { ...groups, stages: [], running: [], coming: [], ratings: [] };
  const many = Array.from({ length: 16 }, (_, at) => ({ name: `team ${at}`, withdrawn: at === 3 }));
  assert.deepEqual(
    slides({ ...before, teams: many }).map(({ is, teams }) => [is, teams.length]),
    [["entered", 15]],
  );
  assert.deepEqual(slides({ ...before, teams: [] }), [{ is: "entered", teams: [] }]);
  assert.equal(slides({ ...before, teams: [...many, ...many] }).length, 2);
  const courts = Array.from({ length: 6 }, (_, number) => ({
    ...{ court: `court-${number + 6}`, pairing: `x:a1.${number}`, teams: ["A", "B"] },
  }));
  const now = slides({ ...groups, running: courts.toReversed() }).filter(({ is }) => is === "now");
  const games = now.map((slide) => slide.games.map(({ court }) => court));
  assert.deepEqual(
    games.flat().slice(0, 6),
    courts.map(({ court }) => court),
  );
  assert.ok(games.every(({ length }) => length <= 4));
  assert.equal(games[0].length, 4);
});

test("a podium has the first three ranks, shared ones too, and the teams after them", () => {
  const ranks = (sheet) => podium(sheet).steps.map(({ rank, teams }) => [rank, teams.length]);
  assert.deepEqual(ranks(finals), [
    [1, 1],
    [2, 1],
    [3, 1],
  ]);
  assert.deepEqual(
    podium(finals).more.map(({ rank }) => rank),
    [4],
  );
  assert.deepEqual(podium(groups), { steps: [], more: [] });
});

test("a projector shows the match that is played, and tables between matches", () => {
  const turns = new Turns();
  const at = (ms, court, phase) => turns.isPicture(ms, court ? { court, phase } : null);
  const { LOBBY, COUNTDOWN, PLAYING, FINISHED, OFFICIAL } = Phase;
  assert.equal(at(0, null), false);
  assert.equal(at(1000, "a", LOBBY), false);
  assert.equal(at(2000, "a", COUNTDOWN), true);
  assert.equal(at(3000, "a", PLAYING), true);
  assert.equal(at(5000, null), true, "a link that breaks for a moment");
  assert.equal(at(9000, null), false, "a court that is gone");
  assert.equal(at(10_000, "a", FINISHED), true);
  assert.equal(at(20_000, "a", OFFICIAL), true);
  assert.equal(at(29_000, "a", OFFICIAL), true);
  assert.equal(at(31_000, "a", OFFICIAL), false, "the result had its time");
  assert.equal(at(32_000, "a", COUNTDOWN), true, "the next match of the same court");
  assert.equal(at(60_000, "a", FINISHED), true);
  assert.equal(at(66_000, "b", PLAYING), false, "tables after a match, while others play");
  assert.equal(at(110_000, "b", PLAYING), true);
});

test("a court that has gone is named only to who saw it on air", () => {
  const cuts = new Cuts();
  const why = (court, why, isSeen) => cuts.why({ court, why }, isSeen, Phase.PLAYING);
  assert.equal(why("a", "gone", true), "", "the page has just come");
  assert.equal(why("b", "gone", false), "gone");
  assert.equal(why("b", "gone", true), "gone", "as long as it is on air");
  assert.equal(why("a", "played", false), "played");
  assert.equal(why("b", "gone", true), "", "tables were shown meanwhile");
});

test("the reason for a cut ends with the play that it was about", () => {
  const cuts = new Cuts();
  const why = (phase, court = "a", why = "closing") => cuts.why({ court, why }, true, phase);
  assert.equal(why(Phase.CREATED), "closing", "the picture is not here yet");
  assert.equal(why(Phase.PLAYING), "closing");
  assert.equal(why(Phase.HALTED), "closing");
  for (const phase of [Phase.FINISHED, Phase.OFFICIAL, Phase.CREATED, Phase.LOBBY, Phase.PLAYING])
    assert.equal(why(phase), "", "also in the next match of this court");
  assert.equal(why(Phase.PLAYING, "b"), "closing", "of the next court");
  assert.equal(why(Phase.OFFICIAL, "a", "gone"), "gone", "of a court that was over already");
});

test("a projector that comes after the end shows no match of before", () => {
  const turns = new Turns();
  const at = (ms, phase, isOver) => turns.isPicture(ms, { court: "a", phase }, isOver);
  assert.equal(at(0, Phase.PLAYING, true), false, "the director shows it later than it was");
  assert.equal(at(1000, Phase.OFFICIAL, true), false);
  assert.equal(at(2000, Phase.PLAYING, false), true, "a game is played again");
  assert.equal(at(3000, Phase.OFFICIAL, true), true, "its result, which the page came in time for");
});

test("all pages name the teams of a match in one order, from game to game", () => {
  const pairing = { id: "cup:w1.1" };
  const open = { pairing, teams: ["Ants", "Bees"], games: [], next_seats: ["Bees", "Ants"] };
  assert.deepEqual(c.seating(open), [1, 0]);
  const game = { number: 1, teams: ["Bees", "Ants"], scores: [3, 1], outcome: "left" };
  const later = { ...open, games: [game], next_seats: ["Ants", "Bees"] };
  assert.deepEqual(c.seating(later), [1, 0]);
  assert.deepEqual(c.seating({ ...later, games: [game, { ...game, number: 2 }] }), [1, 0]);
  assert.deepEqual(c.seating({ ...open, next_seats: null }), [0, 1]);
  const sheet = { stages: [{ matches: [later] }], coming: [], later: [] };
  const call = { id: "c1", pairing: "cup:w1.1", game: 2, teams: ["Ants", "Bees"], court: "east" };
  const [next] = g.nextGames({ ...sheet, running: [call] }, 1);
  assert.deepEqual([next.teams, next.swapped], [["Bees", "Ants"], true]);
  assert.deepEqual(c.named(sheet, "cup:w1.1", ["Bees", "Ants"]).swapped, false);
  assert.deepEqual(c.named(sheet, "cup:w9.9", ["Bees", "Ants"]).teams, ["Bees", "Ants"]);
});

test("a place that a level match decided says by what", () => {
  const rows = [
    { team: "Ants", decided_by: "" },
    { team: "Bees", decided_by: "" },
    { team: "Cats", decided_by: "" },
    { team: "Dogs", decided_by: "seed" },
  ];
  assert.deepEqual(c.levelPlaces({ rows }), [{ above: "Cats", below: "Dogs", tie: "seed" }]);
});

test("a name that is too long for its box is cut by its width", () => {
  assert.equal(fit("Ants", 4), "Ants");
  assert.equal(fit("Unstoppable Walkers", 6), "Unstoppab…");
  assert.equal(fit("九州工業大学ロボット研究会", 6), "九州工業大…");
});

test("teams that are equal in all are first together, and their places name each other", () => {
  const view = structuredClone(cup(swiss));
  const [table] = view.tables;
  view.matches = [];
  view.rounds_to_draw = 0;
  for (const row of table.rows.slice(0, 2)) Object.assign(row, { rank: 1, shares: true });
  const [one, other] = table.rows.map(({ team }) => team);
  const over = { ...swiss, stages: [view], planned: [] };
  assert.deepEqual(c.champions(over), [one, other]);
  assert.deepEqual(
    places(over)
      .slice(0, 3)
      .map(({ team, rank, equal, won }) => ({ team, rank, equal, won })),
    [
      { team: one, rank: 1, equal: [other], won: true },
      { team: other, rank: 1, equal: [one], won: true },
      { team: table.rows[2].team, rank: table.rows[2].rank, equal: [], won: false },
    ],
  );
});
