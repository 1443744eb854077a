/** Who plays, across the lower part of the picture, when play has begun. */

import { computed } from "@preact/signals";
import { useMemo } from "preact/hooks";
import { eventFeed } from "../core/contest/feed";
import type { Match } from "../core/match";
import { BEATS_PER_S, Phase } from "../core/wire";
import { t } from "../i18n";
import { team } from "../i18n/words";
import { SeatMark } from "./score";
import { TeamPicture } from "./team_picture";
import "./thirds.css";

/** After "Go", and until the first points are likely. */
const FROM_TICKS = BEATS_PER_S;
const UNTIL_TICKS = 6 * BEATS_PER_S;

/** Each team with its robot; by the match's own time, so that it is right in a replay too. */
export function Introductions({ match }: { match: Match }) {
  const contest = eventFeed.sheet.value;
  const shown = useMemo(
    () =>
      computed(() => {
        const frame = match.frame.value;
        if (frame?.phase !== Phase.PLAYING) return false;
        return frame.clock_ticks >= FROM_TICKS && frame.clock_ticks < UNTIL_TICKS;
      }),
    [match],
  ).value;
  const sheet = match.sheet.value;
  if (!shown || !sheet || sheet.seats.length < 2) return null;
  return (
    <ul class="thirds" aria-label={t("intro.label")}>
      {sheet.seats.map(({ id, robot, legs, keys }, index) => (
        <li key={id} class="third" data-seat={index}>
          <SeatMark sheet={sheet} index={index} />
          <TeamPicture sheet={contest} team={team(sheet, index)} />
          <span class="what">
            {team(sheet, index)}
            <small>{t("intro.robot", { robot, legs: legs.length, keys: keys[1].length })}</small>
          </span>
        </li>
      ))}
    </ul>
  );
}
