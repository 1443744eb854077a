// Tests of the table of a gait (client/web/src/core/design/table.ts, tools.ts, history.ts).

import assert from "node:assert/strict";
import { readFileSync } from "node:fs";
import { test } from "node:test";
import { History } from "../../../client/web/src/core/design/history.ts";
import * as rows from "../../../client/web/src/core/design/rows.ts";
import * as t from "../../../client/web/src/core/design/table.ts";
import * as tools from "../../../client/web/src/core/design/tools.ts";

const SAMPLE = new URL(
  "../../../robots/lacoc_robots/samples/hexapod/Loco-data.txt",
  import.meta.url,
);
const LEGS = ["R,F", "R,C", "R,B", "L,B", "L,C", "L,F"];
const columns = { legs: LEGS, ranges: Array(18).fill([-150, 150]) };

/** The sample's table. */
const sample = t.fromWire(
  {
    kind: "postures",
    legs: 6,
    rows: readFileSync(SAMPLE, "utf-8")
      .split("\n")
      .filter((line) => /^\d Key/.test(line))
      .map((line) => line.split("\t"))
      .map(([name, ...angles]) => ({
        key: Number(name[0]),
        posture: 0,
        angles_deg: angles.map(Number),
      })),
  },
  columns,
);

test("keys 3 and 4 of the sample are the mirror of 1 and 2", () => {
  assert.equal(sample.rows.length, 9);
  const halves = tools.halvesOf(rows.sequenceOf(sample, 2, ["0", "8765", "1234", "5678"]));
  assert.deepEqual(halves, [
    { from: 1, to: 3 },
    { from: 2, to: 4 },
  ]);
  assert.equal(tools.otherHalf(sample, halves), sample);
  const broken = t.clear(sample, t.areaOf({ row: 3, col: 0 }, { row: 4, col: 17 }));
  assert.deepEqual(tools.otherHalf(broken, halves), sample);
});

test("a step that is undone has its version again", () => {
  const history = new History(sample);
  history.apply("nudge", (table) => t.nudge(table, t.areaOf({ row: 1, col: 0 }), 5));
  assert.equal(history.version.value, 2);
  history.undo();
  assert.deepEqual([history.version.value, history.table.value], [1, sample]);
});
