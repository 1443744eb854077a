/** Who will probably win, as a bar in both colours below the score. */

import { computed } from "@preact/signals";
import { useMemo } from "preact/hooks";
import { chanceNow } from "../core/chance";
import type { Match } from "../core/match";
import { t } from "../i18n";
import "./chance.css";

export function ChanceBar({ match }: { match: Match }) {
  const percent = useMemo(
    () =>
      computed(() => {
        const { frame, sheet } = { frame: match.frame.value, sheet: match.sheet.value };
        const chance = frame && sheet && chanceNow(frame, sheet);
        return chance === null ? null : Math.round(100 * chance);
      }),
    [match],
  ).value;
  if (percent === null) return null;
  return (
    <p class="chance" title={t("odds.byScore")} style={`--first: ${percent}%`}>
      <span class="hidden-text">{t("odds.byScore")}: </span>
      <b>{percent} %</b>
      <i aria-hidden="true" />
      <b>{100 - percent} %</b>
    </p>
  );
}
