/** The gait and its robot, as requests send them. */

import { keysOf } from "../../../core/design/rows";
import { type Table, toWire } from "../../../core/design/table";
import { SAMPLE_SEQUENCES, sequences } from "../../../core/files";
import type { FileTable, SentFile } from "../../../core/wire";
import type { RobotInUse } from "../robot/robot";
import type { Sheet } from "../table/sheet";

export interface SentGait {
  table: FileTable;
  robot: SentFile | null;
  /** The digits of each key of level B; null where the table itself has them. */
  sequences: number[][] | null;
}

/** A table, such as the one that is there now; null while a cell has no angle. */
export function sentGait(
  sheet: Sheet,
  robot: RobotInUse,
  table = sheet.table.peek(),
): SentGait | null {
  const wire = table && toWire(table);
  return wire && { table: wire, robot: robot.sent(), sequences: digitsOf(table) };
}

/**
 * The sequences that came with a table, as the page keeps them; null: they are what is there.
 *
 * @param sent The digits of each key; null: the sample's.
 */
export function keysFrom(table: Table, sent: number[][] | null): readonly string[] | null {
  if (table.kind === "locomotion") return null;
  // What was typed for a key whose postures are not all there is not sent: it stays.
  if (JSON.stringify(sent) === JSON.stringify(digitsOf(table))) return null;
  return sent?.map((digits) => digits.join("")) ?? SAMPLE_SEQUENCES;
}

function digitsOf(table: Table): number[][] | null {
  if (table.kind === "locomotion") return null;
  const keys = new Set(keysOf(table));
  // Each key needs postures, also one that is not tried, and whose own are not all there.
  const filler = [table.rows[0]!.key];
  return sequences.peek().map((digits) => {
    const found = [...digits].map(Number);
    return found.length && found.every((digit) => keys.has(digit)) ? found : filler;
  });
}
