/** All keys of a contestant, in words. */

import { ARROWS } from "../../core/keys";
import { Level, type Sheet } from "../../core/wire";
import { t } from "../../i18n";
import type { KeyRow } from "../../ui/key_help";
import { ARROW_OF } from "./pad";

export function keyRows(sheet: Sheet | null, alone: boolean): readonly KeyRow[] {
  const levels = sheet?.levels ?? [];
  const arrows = Object.values(ARROWS)
    .toSorted((one, other) => one - other)
    .map((digit) => ARROW_OF.get(digit) ?? "");
  const rows: [boolean, KeyRow][] = [
    [true, [["0", "…", "9"], t("keys.digits")]],
    [
      levels.includes(Level.LOCOMOTION),
      [arrows, t(levels.length > 1 ? "keys.arrowsB" : "keys.arrows")],
    ],
    [levels.length > 1, [["Tab"], t("keys.level")]],
    [true, [["x"], t("keys.restart")]],
    [true, [["Space"], t("keys.view")]],
    [!alone, [["M"], t("keys.mute")]],
    [!alone, [["r"], t("keys.ready")]],
    [true, [["z"], t(alone ? "keys.leavePractice" : "keys.leave")]],
    [true, [levels.length > 1 ? ["Esc"] : ["Tab", "Esc"], t("keys.out")]],
  ];
  return rows.flatMap(([isThere, row]) => (isThere ? [row] : []));
}
