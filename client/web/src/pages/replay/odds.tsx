/** The odds of a recording: those at the beat that is shown, and where they changed most. */

import { computed } from "@preact/signals";
import { useMemo } from "preact/hooks";
import { highlights, type Odds } from "../../core/odds";
import type { Sheet } from "../../core/wire";
import { t } from "../../i18n";
import { BEATS_PER_S, clockTicks, logClock, team } from "../../i18n/words";
import { chancesAt } from "../../ui/odds";
import type { Player } from "./player";

/** A component of its own, because it is drawn again at each beat. */
export function ChancesNow({ player, odds }: { player: Player; odds: Odds }) {
  const shown = useMemo(
    () => computed(() => chancesAt(odds, player.recording.beat.value)),
    [odds, player],
  ).value;
  return (
    <span class="chances" title={t(odds.by === "forks" ? "odds.about" : "odds.byScore")}>
      <small class="muted">{t("odds.title")}</small> <b>{shown}</b>
    </span>
  );
}

/** The list of highlights; each of them leads to its moment. */
export function Highlights({ player, odds }: { player: Player; odds: Odds }) {
  const found = useMemo(() => highlights(odds), [odds]);
  const sheet = player.recording.record.sheets.at(-1)?.value;
  if (!found.length || !sheet) return null;
  return (
    <section class="highlights-part">
      <h2>{t("odds.highlights")}</h2>
      <ol class="highlights">
        {found.map(({ before, after, change }) => (
          <li key={before.beat} data-seat={change > 0 ? 0 : 1}>
            <button type="button" onClick={() => player.seek(before.beat)}>
              <time>{clockAt(before.clock_s, sheet)}</time>
              <span>
                {t("odds.swing", {
                  team: team(sheet, change > 0 ? 0 : 1),
                  before: percent(before.chance, change),
                  after: percent(after.chance, change),
                })}
              </span>
            </button>
          </li>
        ))}
      </ol>
    </section>
  );
}

/** The time that the clock showed. */
function clockAt(played_s: number, sheet: Sheet): string {
  return logClock(clockTicks({ clock_ticks: Math.round(played_s * BEATS_PER_S) }, sheet));
}

/** The chance of the seat that gained, in percent. */
function percent(chance: number, change: number): number {
  return Math.round(100 * (change > 0 ? chance : 1 - chance));
}
