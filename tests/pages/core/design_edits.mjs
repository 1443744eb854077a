// Random edits of a table, for tests.

import { paste } from "../../../client/web/src/core/design/clipboard.ts";
import * as rows from "../../../client/web/src/core/design/rows.ts";
import * as t from "../../../client/web/src/core/design/table.ts";
import * as tools from "../../../client/web/src/core/design/tools.ts";

/** Makes a random edit of a table. */
export function editOf(chance) {
  const below = (count) => Math.floor(chance() * count);
  const numbers = Array.from({ length: 12 }, () => below(1000));
  const pick = (index, count) => numbers[index] % count;
  const text = ["17", "-22,5", "abc", "", "400", "１２"][below(6)];
  const edits = [
    (table, area) => t.setCell(table, area.top, area.left, text),
    (table, area) => t.nudge(table, area, pick(4, 21) - 10),
    (table, area) => t.clear(table, area),
    (table, area) => rows.addRow(table, area.top),
    (table, area) => rows.removeRow(table, area.bottom),
    (table, area) => rows.addKey(table, area.top),
    (table, area) => tools.mirrorRows(table, [area.top, area.bottom]),
    (table, area) => tools.otherHalf(table, [{ from: area.top, to: area.bottom }]),
    (table, area) => tools.copyLeg(table, [area.top], pick(4, 6), pick(5, 6)),
    (table, area) => paste(table, area, [[text, "5"]]).table ?? table,
  ];
  const edit = edits[below(edits.length)];
  return (table) => {
    const cell = (at) => ({ row: pick(at, table.rows.length), col: pick(at + 1, 18) });
    return edit(table, t.areaOf(cell(0), cell(2)));
  };
}
