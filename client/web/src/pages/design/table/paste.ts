/** Pastes a block of numbers into the table, or hands a whole sheet to the reader of files. */

import {
  type BadPaste,
  isWholeSheet,
  paste,
  readBlock,
  writeBlock,
} from "../../../core/design/clipboard";
import type { Table } from "../../../core/design/table";
import { type MessageName, t } from "../../../i18n";
import { toast } from "../../../ui/toasts";
import { jointName, rowName } from "../names";
import type { Sheet } from "./sheet";

/** The name under which a pasted sheet goes to the reader of files. */
const PASTED = "Loco-data.txt";

/** Reads a file. */
export type Parse = (name: string, data: Uint8Array) => void;

/** Put what is on the clipboard into the table: all of it, or nothing. */
export function pasteInto(sheet: Sheet, plain: string, html: string, parse: Parse): void {
  const table = sheet.table.peek();
  const block = readBlock(plain, html);
  if (!table || !block.length) return;
  if (isWholeSheet(block)) {
    parse(PASTED, new TextEncoder().encode(plain || writeBlock(block)));
    return;
  }
  const pasted = paste(table, sheet.area.peek(), block);
  if ("bad" in pasted) {
    refusePaste(sheet, table, pasted.bad);
    return;
  }
  sheet.edit(t("design.step.paste"), () => pasted.table, null, "paste");
  const { top, left, bottom, right } = pasted.area;
  sheet.select({ row: top, col: left }, { row: bottom, col: right });
}

/** Say why nothing was pasted; the cells that are in the way turn red. */
function refusePaste(sheet: Sheet, table: Table, bad: readonly BadPaste[]): void {
  const inside = bad.filter(({ why }) => why !== "outside");
  sheet.unpasted.value = inside.map(({ row, col, text, why }) => ({
    row,
    col,
    why: `“${text}” ${t(`design.bad.${why}` as MessageName, rangeOf(table, col))}`,
  }));
  const [first] = inside;
  if (!first) {
    toast(t("design.notPastedOutside"), "no");
    return;
  }
  const { row, col, text, why } = first;
  const reason = t(`design.bad.${why}` as MessageName, rangeOf(table, col));
  const name = rowName(table.rows[row]!, table.kind === "locomotion");
  const where = jointName(table.legs, col);
  toast(t("design.notPasted", { text, row: name, where, reason }), "no");
}

/** The range of a joint, for a message. */
export function rangeOf(table: Table, col: number): { low: number; high: number } {
  const [low, high] = table.ranges[col] ?? [0, 0];
  return { low, high };
}
