// Tests of a class as its teacher sees it (client/web/src/core/class.ts).

import assert from "node:assert/strict";
import { test } from "node:test";
import * as c from "../../../client/web/src/core/class.ts";
import { chanceOf } from "./design_sample.mjs";

const PLAIN = {
  online: true,
  phase: 1,
  share: 0,
  hand_up_s: null,
  need: "",
};
const card = (name, more = {}) => ({ ...PLAIN, name, ...more });
const hand = (name, since) => card(name, { need: "hand", hand_up_s: since });
const names = (cards) => cards.map(({ name }) => name).join(" ");

test("whoever needs help comes first, and whoever is away comes last", () => {
  const cards = [
    card("away", { online: false, need: "hand", hand_up_s: 1 }),
    card("far", { phase: 4 }),
    card("half", { phase: 2, share: 0.5 }),
    card("begun", { phase: 2, share: 0.1 }),
    card("quiet", { need: "quiet", phase: 6 }),
    card("stuck", { need: "stuck", phase: 6 }),
    hand("late", 200),
    hand("early", 100),
  ];
  const order = "early late stuck quiet begun half far away";
  const chance = chanceOf(1);
  for (let round = 0; round < 50; round++) {
    const mixed = cards.toSorted(() => chance() - 0.5);
    assert.equal(names(c.placed([], mixed, false)), order);
  }
});

test("cards that are held keep their places, and new ones follow them", () => {
  const cards = [hand("dan", 5), card("ann", { phase: 3 }), card("bob"), card("new")];
  assert.equal(names(c.placed(["ann", "bob", "dan", "gone"], cards, true)), "ann bob dan new");
  assert.equal(names(c.placed(["ann", "bob", "dan"], cards, false)), "dan bob new ann");
});

test("a card replaces the one of the same student", () => {
  const cards = [card("ann"), card("bob")];
  assert.deepEqual(c.withCard(cards, card("ann", { phase: 2 })), [
    card("ann", { phase: 2 }),
    card("bob"),
  ]);
  assert.equal(names(c.withCard(cards, card("cem"))), "ann bob cem");
});

test("a projector's numbers stay, and are never given to somebody else", () => {
  const first = c.numbered([], ["ann", "bob"]);
  assert.equal(c.numbered(first, ["bob", "ann"]), first);
  const left = c.numbered(first, ["bob"]);
  assert.deepEqual(left, ["", "bob"]);
  assert.deepEqual(c.numbered(left, ["bob", "cem", "ann"]), ["", "bob", "cem", "ann"]);
});

test("names in a text are hidden, in any script", () => {
  const label = (index) => `Robot ${index + 1}`;
  const cases = [
    ["Ann's table", ["Ann"], "Robot 1's table"],
    ["Anna and Ann", ["Ann", "Anna"], "Robot 2 and Robot 1"],
    ["A table", ["able"], "A table"],
    ["花子の表", ["花子"], "Robot 1の表"],
    ["a (b) c", ["(b)"], "a Robot 1 c"],
    ["nobody", ["", ""], "nobody"],
  ];
  for (const [text, known, hidden] of cases) assert.equal(c.masked(text, known, label), hidden);
});

test("a passed time is given in minutes, and from an hour on in hours", () => {
  const cases = [
    [0, "moment", 0],
    [-30, "moment", 0],
    [59, "moment", 0],
    [60, "min", 1],
    [3599, "min", 59],
    [7300, "h", 2],
  ];
  for (const [seconds, unit, count] of cases) {
    assert.deepEqual(c.elapsed(1000 + seconds, 1000), { unit, count });
  }
});

test("a phase is closed and opened again", () => {
  const closed = c.toggled(c.toggled(c.OPEN_RULES, 5), 2);
  assert.deepEqual(closed.closed, [2, 5]);
  assert.deepEqual(c.toggled(closed, 2).closed, [5]);
});

test("foot bars are a row for each leg, 100 wide", () => {
  assert.equal(c.barsPath([[[0, 0.5]], [[0.25, 1]]]), "M0 0.15H50V0.85H0ZM25 1.15H100V1.85H25Z");
});

test("after the end of a stretch its begin follows", () => {
  assert.deepEqual(
    [10, 15, 20, 27, 40].map((tick) => c.looped(tick, 10, 20)),
    [10, 15, 10, 17, 10],
  );
  assert.equal(c.looped(5, 0, 0), 0);
});

test("a group has one card, where its first member stands", () => {
  const ants = { name: "Ants", members: ["b", "d"], roles: {}, word: "", handed: null };
  const cards = ["a", "b", "c", "d"].map((name) => card(name));
  const shown = c
    .dealt(cards, [ants])
    .map(({ group, cards: own }) => [group?.name ?? "", names(own)]);
  assert.deepEqual(shown, [
    ["", "a"],
    ["Ants", "b d"],
    ["", "c"],
  ]);
});
