/** The link in figures, and the way to files and settings. */

import { useComputed } from "@preact/signals";
import type { Court } from "../../core/court";
import type { Player } from "../../core/player";
import { t } from "../../i18n";
import { fixtureOf, seatName, team } from "../../i18n/words";
import { hasKeyboard } from "../../ui/screen";
import { canChange } from "./files";

interface Props {
  court: Court;
  player: Player;
  onKeys: () => void;
  onFiles: () => void;
  onSettings: () => void;
}

export function Footer({ court, player, onKeys, onFiles, onSettings }: Props) {
  const sheet = court.sheet.value;
  const index = player.index.value;
  const seat = sheet?.seats[index];
  const isOpen = useComputed(() => canChange(court)).value;
  const trip = player.tripMs.value;
  const health = court.live.value ? court.health.value : null;
  const link = health?.seats[index]?.round_trip_p50_ms ?? null;
  const isLinked = player.canSteer.value;
  return (
    <footer class="foot">
      <p class="who">
        {sheet && seat && sheet.seats.length > 1 && (
          <b title={team(sheet, index)}>
            {team(sheet, index)} ({seatName(seat.id)})
          </b>
        )}
        <span class="muted court">
          {t("join.court")} {court.welcome.value?.court}
        </span>
        {sheet && (
          <span class="what">
            {fixtureOf(sheet) && <span>{fixtureOf(sheet)}</span>}
            <span>{sheet.title}</span>
          </span>
        )}
      </p>
      <dl>
        <div title={t("foot.tripHint")}>
          <dt>{t("foot.trip")}</dt>
          <dd data-trip={trip ?? ""}>
            {trip === null ? "–" : t("foot.ms", { count: Math.round(trip) })}
          </dd>
        </div>
        <div title={t("foot.linkHint")}>
          <dt>{t("foot.link")}</dt>
          <dd data-link={link ?? ""}>
            {link === null ? "–" : t("foot.ms", { count: Math.round(link) })}
          </dd>
          {!!health?.input_delay_ms && (
            <dd class="muted" title={t("foot.equalHint")}>
              {t("foot.equal", { count: health.input_delay_ms })}
            </dd>
          )}
        </div>
        <div>
          <dt>{t("foot.frames")}</dt>
          <dd>{t("foot.perSecond", { count: court.framesHz.value })}</dd>
        </div>
      </dl>
      <p class={`link-state${isLinked ? " good" : ""}`}>
        {t(isLinked ? "foot.linked" : "foot.broken")}
      </p>
      {hasKeyboard.value && (
        <button class="button quiet small" type="button" onClick={onKeys}>
          {t("keys.title")} <kbd>?</kbd>
        </button>
      )}
      <button class="button quiet small" type="button" disabled={!isOpen} onClick={onFiles}>
        {t("files.change")}
      </button>
      <button class="button quiet small" type="button" onClick={onSettings}>
        {t("foot.settings")}
      </button>
    </footer>
  );
}
