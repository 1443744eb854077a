/** How rows, joints, keys and cells are called, on the page and in its HTML. */

import { LEVELS, legAndLevel, type Row, type Table } from "../../core/design/table";
import { type MessageName, t } from "../../i18n";
import type { Place } from "./table/sheet";

/** The sample's meaning of a key (Fig. 4-2) is known for keys below this one. */
const NAMED = 4;

/** "1", or "2 · 3" for the third posture of key 2. */
export function rowName({ key, posture }: Row, isSequence: boolean): string {
  return isSequence ? `${key} · ${posture + 1}` : String(key);
}

/** "R,F 1st" */
export function jointName(legs: readonly string[], joint: number): string {
  const { leg, level } = legAndLevel(joint, legs.length);
  return `${legs[leg] ?? leg} ${LEVELS[level]}`;
}

/** "row 2, R,F 1st": the place of a number in the table. */
export function placeName({ rows, legs, kind }: Table, row: number, joint: number): string {
  const found = rows[row];
  const name = found ? rowName(found, kind === "locomotion") : "?";
  return t("design.place", { row: name, joint: jointName(legs, joint) });
}

/** "forward"; "" for a key that the sample does not have. */
export function keyMeaning(key: number): string {
  return key < NAMED ? t(`design.key.${key}` as MessageName) : "";
}

/** "2 forward" */
export function keyName(key: number): string {
  return `${key} ${keyMeaning(key)}`.trim();
}

export function cellId({ row, col }: Place): string {
  return `cell-${row}-${col}`;
}

export function classes(...names: (string | false | undefined | null)[]): string {
  return names.filter(Boolean).join(" ");
}
