// The sample's gait as a table of the page /design, for tests.

import { readFileSync } from "node:fs";
import { fromWire } from "../../../client/web/src/core/design/table.ts";

export const LEGS = ["R,F", "R,C", "R,B", "L,B", "L,C", "L,F"];
export const COLUMNS = { legs: LEGS, ranges: Array(18).fill([-150, 150]) };
export const SEQUENCES = ["0", "8765", "1234", "5678"];

const SAMPLES = new URL("../../../robots/lacoc_robots/samples/hexapod/", import.meta.url);
const lines = (name) => readFileSync(new URL(name, SAMPLES), "utf-8").split("\n");

/** Loco-data: keys 0 to 8. */
export const sample = fromWire(
  {
    kind: "postures",
    legs: 6,
    rows: lines("Loco-data.txt")
      .filter((line) => /^\d Key/.test(line))
      .map((line) => line.split("\t"))
      .map(([name, ...cells]) => ({
        key: Number(name[0]),
        posture: 0,
        angles_deg: cells.map(Number),
      })),
  },
  COLUMNS,
);

/** LocoTra-data: stand, left, forward, right. */
export const walking = fromWire(
  {
    kind: "locomotion",
    legs: 6,
    rows: SEQUENCES.flatMap((digits, key) =>
      [...digits].map((digit, posture) => ({
        key,
        posture,
        angles_deg: sample.rows[Number(digit)].cells,
      })),
    ),
  },
  COLUMNS,
);

/** Numbers from 0 to below 1, the same in each run. */
export function chanceOf(seed) {
  let state = seed;
  return () => {
    state = (state * 16807) % 2147483647;
    return state / 2147483647;
  };
}
