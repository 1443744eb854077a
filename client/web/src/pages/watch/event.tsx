/** Between the matches of an event: which event this is, and what comes next. */

import { useComputed } from "@preact/signals";
import { useEffect } from "preact/hooks";
import { Feed } from "../../core/contest/feed";
import { nextGames } from "../../core/contest/games";
import { type ContestSheet, stateOf, teamsOf } from "../../core/contest/sheet";
import type { Court } from "../../core/court";
import { Phase } from "../../core/wire";
import { t } from "../../i18n";
import { hint } from "../../i18n/words";
import { directorBegins } from "../../ui/banner";
import { expected, gameTitle } from "../contest/words";
import "../../ui/opening.css";

const GAMES_MOST = 3;
const feed = new Feed();

/** Whether a court waits for a match of the event; it changes only when the answer does. */
export function useBetween(court: Court): boolean {
  return useComputed(() => {
    const sheet = court.sheet.value;
    const waits = court.frame.value?.phase === Phase.LOBBY && !!sheet?.fixture && !sheet.call;
    return waits || !court.begun.value;
  }).value;
}

/** The event, how it stands, and its next games. */
export function EventCard({ court }: { court: Court }) {
  const { contest = "", desk = false } = court.welcome.value ?? {};
  useEffect(() => (desk ? feed.start() : undefined), [desk]);
  const sheet = desk ? feed.sheet.value : null;
  const next = useComputed(() => (court.begun.value ? hint(court) : t("event.waits"))).value;
  const waits = directorBegins(court) || next;
  return (
    <section class="opening event" aria-label={t("event.title")}>
      <h1>{contest || "LACOC"}</h1>
      {sheet && <Coming sheet={sheet} />}
      <p class="rules">{waits}</p>
    </section>
  );
}

function Coming({ sheet }: { sheet: ContestSheet }) {
  const games = nextGames(sheet, GAMES_MOST);
  if (!games.length) {
    return (
      <p class="next">
        {t(`contest.state.${stateOf(sheet)}`)} ·{" "}
        {t("contest.teamCount", { count: teamsOf(sheet).here })}
      </p>
    );
  }
  return (
    <>
      <h2 class="kicker">{t("contest.coming")}</h2>
      <ul class="coming">
        {games.map(({ pairing, game, teams: [left, right], court, call, at_ms }) => (
          <li key={`${pairing}/${game}`}>
            <b>{t("contest.versus", { left, right })}</b>{" "}
            <span class="kicker">
              {gameTitle(sheet, pairing, game)}
              {call && ` · ${t("contest.court", { court })}`}
              {at_ms > 0 && ` · ${expected(sheet, { at_ms, court })}`}
            </span>
          </li>
        ))}
      </ul>
    </>
  );
}
