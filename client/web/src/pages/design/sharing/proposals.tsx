/** What partners propose for one's own rows, and what one has proposed. */

import { t } from "../../../i18n";
import { placeName } from "../names";
import type { Sheet } from "../table/sheet";
import type { Group } from "./group";

const SHOWN = 3;

export function Proposals({ group, sheet }: { group: Group; sheet: Sheet }) {
  const table = sheet.table.value;
  const all = group.proposals.value.filter(({ isMine }) => isMine);
  if (!table || !all.length) return null;
  return (
    <ul class="proposals" aria-label={t("design.group.proposals")}>
      {all.slice(0, SHOWN).map((one) => {
        const place = placeName(table, one.row, one.col);
        return (
          <li key={one.name}>
            <button
              class="place"
              type="button"
              onClick={() => sheet.select({ row: one.row, col: one.col })}
            >
              {t("design.group.proposal", { name: one.by, place, angle: one.text })}
            </button>
            <button class="button strong small" type="button" onClick={() => group.takeIn(one)}>
              {t("design.group.takeIn")}
            </button>
            <button class="button small" type="button" onClick={() => group.dismiss([one])}>
              {t("design.group.dismiss")}
            </button>
          </li>
        );
      })}
      {all.length > SHOWN && (
        <li>
          {t("design.group.more", { count: all.length - SHOWN })}
          <button
            class="button small"
            type="button"
            onClick={() => {
              for (const one of all) group.takeIn(one);
            }}
          >
            {t("design.group.takeAll")}
          </button>
        </li>
      )}
    </ul>
  );
}
