/** Takes over the leg that the lesson of one leg gives with the address. */

import { setting } from "../../../core/address";
import { joint, setCell } from "../../../core/design/table";
import { GIVEN_LEG, readGiven } from "../../../core/leg/given";
import { t } from "../../../i18n";
import { toast } from "../../../ui/toasts";
import { rowName } from "../names";
import type { Sheet } from "./sheet";

/** The key whose first posture gets the angles, by kind of table: posture 1, or the first of forward. */
const KEYS = { postures: 1, locomotion: 2 } as const;

/** Put a given leg into posture 1, once: a reload finds an address without it. */
export function takeGivenLeg(sheet: Sheet): void {
  const given = readGiven(setting(GIVEN_LEG));
  const table = sheet.table.peek();
  if (!given || !table) return;
  forget();
  const row = table.rows.findIndex(({ key, posture }) => key === KEYS[table.kind] && posture === 0);
  const leg = table.legs.indexOf(given.label);
  if (row < 0 || leg < 0) {
    toast(t("design.given.none", { leg: given.label }), "no");
    return;
  }
  const col = (level: number) => joint(leg, level, table.legs.length);
  const change = (before: typeof table) =>
    given.angles.reduce(
      (made, angle, level) => setCell(made, row, col(level), String(angle)),
      before,
    );
  sheet.select({ row, col: col(0) });
  // The lesson's numbers are no work at the table: phase 1 is still to be done.
  sheet.edit(t("design.given.step"), change, null, "lesson");
  const values = { leg: given.label, row: rowName(table.rows[row]!, table.kind === "locomotion") };
  toast(t("design.given", values));
}

function forget(): void {
  const query = new URLSearchParams(location.search);
  query.delete(GIVEN_LEG);
  const rest = query.toString();
  history.replaceState(null, "", location.pathname + (rest && `?${rest}`) + location.hash);
}
