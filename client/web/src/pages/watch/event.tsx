/** Between the matches of an event: which event this is, and what comes next. */

import { useComputed } from "@preact/signals";
import { useEffect } from "preact/hooks";
import { eventFeed } from "../../core/contest/feed";
import { nextGames, tableAhead } from "../../core/contest/games";
import { type ContestSheet, champions, stateOf, teamsOf } from "../../core/contest/sheet";
import type { Court } from "../../core/court";
import { Phase } from "../../core/wire";
import { t } from "../../i18n";
import { hint } from "../../i18n/words";
import { directorBegins } from "../../ui/banner";
import { TeamPicture } from "../../ui/team_picture";
import {
  expected,
  gameTitle,
  groupTitle,
  listed,
  signed,
  stageTitle,
  winnersTitle,
} from "../contest/words";
import "../../ui/opening.css";

const GAMES_MOST = 3;
const ROWS_MOST = 8;

/** Keep the sheet of the event as new as the court's picture, for teams, tables and games. */
export function useEvent(court: Court): void {
  const desk = court.welcome.value?.desk;
  const behindMs = court.behindMs.value;
  useEffect(() => {
    eventFeed.behindMs = behindMs;
  }, [behindMs]);
  useEffect(() => (desk ? eventFeed.start() : undefined), [desk]);
}

/** The event, how it stands, and its next games. */
export function EventCard({ court }: { court: Court }) {
  const { contest = "", desk = false } = court.welcome.value ?? {};
  const sheet = desk ? eventFeed.sheet.value : null;
  const next = useComputed(() => {
    if (!court.begun.value) return t("event.waits");
    return court.frame.value?.phase === Phase.LOBBY ? hint(court) : "";
  }).value;
  const waits = directorBegins(court) || next;
  return (
    <section class="opening event" aria-label={t("event.title")}>
      <h1>{contest || "LACOC"}</h1>
      {sheet && <Coming sheet={sheet} />}
      {waits && <p class="rules">{waits}</p>}
    </section>
  );
}

function Coming({ sheet }: { sheet: ContestSheet }) {
  const games = nextGames(sheet, GAMES_MOST);
  const winners = champions(sheet);
  if (!games.length) {
    return (
      <>
        <div class="pictures">
          {winners.map((team) => (
            <TeamPicture key={team} sheet={sheet} team={team} />
          ))}
        </div>
        <p class="next">
          {winners.length > 0
            ? `${winnersTitle(winners)}: ${listed(winners)}`
            : `${t(`contest.state.${stateOf(sheet)}`)} · ${t("contest.teamCount", { count: teamsOf(sheet).here })}`}
        </p>
        <TableAhead sheet={sheet} />
      </>
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
      <TableAhead sheet={sheet} />
    </>
  );
}

/** How the teams of the next game stand, where they stand in a table. */
function TableAhead({ sheet }: { sheet: ContestSheet }) {
  const ahead = tableAhead(sheet);
  if (!ahead?.table.rows.length) return null;
  const { view, table } = ahead;
  const title = [stageTitle(sheet, view.stage.name), groupTitle(view, table.section)];
  return (
    <table class="ahead">
      <caption class="kicker">{title.filter(Boolean).join(" · ")}</caption>
      <thead>
        <tr>
          <th scope="col">
            <span class="hidden-text">{t("contest.rank")}</span>
          </th>
          <th scope="col">{t("contest.team")}</th>
          <th scope="col">{t("contest.points")}</th>
          <th scope="col">{t("contest.played")}</th>
          <th scope="col">{t("contest.difference")}</th>
        </tr>
      </thead>
      <tbody>
        {table.rows.slice(0, ROWS_MOST).map((row) => (
          <tr key={row.team}>
            <td>{row.rank}</td>
            <th scope="row">{row.team}</th>
            <td>
              <b>{row.points}</b>
            </td>
            <td>{row.won + row.drawn + row.lost}</td>
            <td>{signed(row.scored - row.conceded)}</td>
          </tr>
        ))}
      </tbody>
    </table>
  );
}
