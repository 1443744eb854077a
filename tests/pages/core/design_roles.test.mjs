// Tests of who owns which rows in a group (client/web/src/core/design/roles.ts).

import assert from "node:assert/strict";
import { test } from "node:test";
import { cellNamed, NO_FILE_ENTRY } from "../../../client/web/src/core/design/entries.ts";
import { guarded, ownersOf } from "../../../client/web/src/core/design/roles.ts";
import * as rows from "../../../client/web/src/core/design/rows.ts";
import { SharedTable } from "../../../client/web/src/core/design/shared_table.ts";
import * as t from "../../../client/web/src/core/design/table.ts";
import { SEQUENCES, sample, walking } from "./design_sample.mjs";

const member = (name, role) => ({ name, role, online: true });

test("forward owns rows 1 to 4, turning rows 5 to 8, nobody row 0 and sequences", () => {
  const members = [member("Ann", "forward"), member("Ben", "turn"), member("Cleo", "")];
  const owner = (key) => ownersOf(sample, { key }, members).map(({ name }) => name);
  assert.deepEqual([0, 1, 4, 5, 8, 9].map(owner), [[], ["Ann"], ["Ann"], ["Ben"], ["Ben"], []]);
  assert.deepEqual(ownersOf(walking, { key: 1 }, members), []);
});

test("what is typed into somebody else's row is proposed, and all else is done", () => {
  const isForeign = ({ key }) => key >= 5;
  const typed = t.setArea(sample, { row: 4, col: 0 }, [
    ["11", "12"],
    ["21", "22"],
  ]);
  const { table, proposed } = guarded(sample, typed, isForeign);
  assert.deepEqual(table.rows[4].cells.slice(0, 2), [11, 12]);
  assert.equal(table.rows[5], sample.rows[5]);
  assert.deepEqual(
    proposed.map(({ row, col, cell }) => [row.key, col, cell]),
    [
      [5, 0, 21],
      [5, 1, 22],
    ],
  );
  const foreign = t.setCell(sample, 6, 3, "5");
  assert.equal(guarded(sample, foreign, isForeign).table, sample, "nothing of it is an edit");
  const longer = rows.addRow(sample, 0);
  assert.equal(guarded(sample, longer, isForeign).table.rows.length, 10);
});

test("a proposal comes over, and goes when it is taken in", () => {
  const updates = [];
  const one = new SharedTable((update, cells) => updates.push({ update, cells }));
  const { kind, rows: all } = sample;
  one.write({ kind, legs: 6, rows: all, keys: SEQUENCES, robot: null, file: NO_FILE_ENTRY });
  one.propose([["p6/5.0/3", "44"]], "Ben");
  assert.deepEqual(updates.at(-1).cells.filter(cellNamed), [], "nobody typed into a cell");
  const other = new SharedTable(() => undefined);
  other.take(one.state());
  const proposal = { name: "p6/5.0/3?", key: 5, rank: 0, col: 3, text: "44", by: "Ben" };
  assert.deepEqual(other.proposals(), [proposal]);
  assert.deepEqual(other.content().rows, all);
  other.remove(["p6/5.0/3?"]);
  one.take(other.state());
  assert.deepEqual(one.proposals(), []);
});
