/** Before play: which robot is one's own, how one scores, and how one steers. */

import { useMemo } from "preact/hooks";
import type { Court } from "../../core/court";
import { phaseOf } from "../../core/match";
import type { Player } from "../../core/player";
import { Level, Phase } from "../../core/wire";
import { t } from "../../i18n";
import { ruleOf, seatName } from "../../i18n/words";
import { SeatMark } from "../../ui/score";

/** Whether there is something to be told before play. */
export function isBrief(phase: number): boolean {
  return phase === Phase.LOBBY || phase === Phase.READY;
}

export function Brief({ court, player }: { court: Court; player: Player }) {
  const phase = useMemo(() => phaseOf(court), [court]).value;
  const sheet = court.sheet.value;
  const index = player.index.value;
  const seat = sheet?.seats[index];
  if (!sheet || !seat || !isBrief(phase)) return null;
  const rule = ruleOf(sheet);
  const hasSequences = sheet.levels.includes(Level.LOCOMOTION);
  return (
    <section class="brief" aria-label={t("brief.label")} data-seat={index}>
      <p class="own">
        <SeatMark sheet={sheet} index={index} />
        {t("brief.own", { seat: seatName(seat.id) })}
      </p>
      <dl>
        {rule && (
          <div>
            <dt>{t("brief.rule")}</dt>
            <dd>{rule}</dd>
          </div>
        )}
        <div class="steering">
          <dt>{t("brief.keys")}</dt>
          <dd>{t(hasSequences ? "brief.once" : "brief.postures")}</dd>
        </div>
      </dl>
    </section>
  );
}
