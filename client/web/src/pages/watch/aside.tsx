/** The director's second picture: a swing at another court, while the one on air stays. */

import { useComputed } from "@preact/signals";
import { useEffect, useMemo, useRef } from "preact/hooks";
import { followColours } from "../../core/colours";
import type { Court } from "../../core/court";
import { scoresOf } from "../../core/match";
import { t } from "../../i18n";
import { team } from "../../i18n/words";
import { View } from "../../scene/View";
import { Shown } from "../../ui/on_air";
import { SeatMark } from "../../ui/score";
import "./aside.css";

/** @param court Follows the second picture. */
export function Aside({ court }: { court: Court }) {
  const host = useRef<HTMLElement>(null);
  useEffect(() => followColours(court, host.current!), [court]);
  const isShown = useComputed(() => {
    const programme = court.programme.value;
    return !!programme?.is_shown && programme.begins_s === 0 && court.live.value;
  }).value;
  const programme = court.programme.value;
  return (
    <section ref={host} class="aside" hidden={!isShown} aria-label={t("director.meanwhile")}>
      <div class="aside-view">
        {/* Over another picture, Chromium leaves a white hole beside an opaque one. */}
        <View source={court} camera="arena" quality="low" transparent label={t("watch.view")} />
      </div>
      <Sides court={court} />
      {programme && <Shown {...programme} label={t("director.meanwhile")} />}
    </section>
  );
}

function Sides({ court }: { court: Court }) {
  const scores = useMemo(() => scoresOf(court), [court]).value;
  const sheet = court.sheet.value;
  if (!sheet || sheet.seats.length < 2) return null;
  return (
    <p class="sides">
      <SeatMark sheet={sheet} index={0} />
      <span>{team(sheet, 0)}</span>
      <b>{scores.replace(" ", " : ")}</b>
      <span>{team(sheet, 1)}</span>
      <SeatMark sheet={sheet} index={1} />
    </p>
  );
}
