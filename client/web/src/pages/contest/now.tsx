/** What is played now, and what comes next. */

import { useEffect } from "preact/hooks";
import { ownPage } from "../../core/address";
import { teamsOfLater } from "../../core/contest/games";
import { LiveScores } from "../../core/contest/live";
import { type ContestSheet, found, named, running, score, written } from "../../core/contest/sheet";
import type { CourtScore } from "../../core/desk.gen";
import { Phase } from "../../core/wire";
import { said, t } from "../../i18n";
import { BEATS_PER_S, clock } from "../../i18n/words";
import { TeamLink } from "./parts";
import { PauseLine } from "./pause";
import { expected, gameTitle, whoTitle } from "./words";

/** Most games to come that are listed. */
const COMING_MOST = 8;

export const live = new LiveScores();

export function Now({ sheet }: { sheet: ContestSheet }) {
  useEffect(() => (ownPage ? undefined : live.start()), []);
  const coming = [...sheet.coming, ...sheet.later];
  const more = coming.length - COMING_MOST;
  return (
    <section id="now" class="now" aria-label={t("contest.now")}>
      <PauseLine sheet={sheet} />
      <div>
        <h2>{t("contest.running")}</h2>
        {!sheet.running.length && <p class="muted">{t("contest.noneRunning")}</p>}
        {!ownPage && sheet.running.length > 1 && (
          <p>
            <a href="watch?director=1">{t("contest.director")}</a>
          </p>
        )}
        <ul class="courts">
          {running(sheet)
            .map((call) => ({ ...call, ...named(sheet, call.pairing, call.teams) }))
            .map(({ id, pairing, game, teams, swapped, court }) => (
              <li key={court} class="court card">
                <div class="where">
                  <b>{t("contest.court", { court })}</b>
                  {!ownPage && (
                    <a
                      href={`watch?court=${encodeURIComponent(court)}`}
                      aria-label={t("contest.watchCourt", { court })}
                    >
                      {t("contest.watch")}
                    </a>
                  )}
                </div>
                <Sides teams={teams} stands={stands(sheet, pairing, teams)} />
                <p class="live-score">
                  <LiveScore score={live.of(id)} swapped={swapped} />
                </p>
                <p class="muted">{gameTitle(sheet, pairing, game)}</p>
              </li>
            ))}
        </ul>
      </div>
      <div>
        <h2>{t("contest.coming")}</h2>
        {!coming.length && <p class="muted">{t("contest.noneComing")}</p>}
        {coming.some((one) => expected(sheet, one)) && (
          <p class="muted">{t("contest.estimates")}</p>
        )}
        <ol class="coming">
          {coming.slice(0, COMING_MOST).map((one) => {
            const teams =
              "who" in one ? teamsOfLater(one) : named(sheet, one.pairing, one.teams).teams;
            return (
              <li key={one.pairing}>
                {teams && <Sides teams={teams} />}
                {"who" in one && !teams && <p>{whoTitle(one.who)}</p>}
                <p class="muted">
                  {"who" in one ? said(one.fixture) : gameTitle(sheet, one.pairing, one.game)}
                </p>
                <p class="expected">{expected(sheet, one)}</p>
              </li>
            );
          })}
        </ol>
        {more > 0 && <p class="muted">{t("contest.more", { count: more })}</p>}
      </div>
    </section>
  );
}

interface LiveProps {
  score: CourtScore | null;
  /** Whether the team that is named first sits right. */
  swapped?: boolean;
  /** Shown before the game begins. */
  otherwise?: string;
}

/** The points and the clock of the game that a court plays. */
export function LiveScore({ score: now, swapped = false, otherwise = "" }: LiveProps) {
  if (!now || now.phase < Phase.PLAYING) return <>{otherwise}</>;
  const [one = 0, other = 0] = swapped ? now.scores.toReversed() : now.scores;
  const shown_s = now.duration_s ? now.duration_s - now.clock_s : now.clock_s;
  return (
    <>
      <b>
        {one} : {other}
      </b>{" "}
      <span>{clock(shown_s * BEATS_PER_S)}</span>
    </>
  );
}

interface SidesProps {
  teams: readonly [string, string];
  /** The score of their match. */
  stands?: readonly [number, number] | null;
}

/** Two teams, in the order of their match. */
function Sides({ teams: [left, right], stands = null }: SidesProps) {
  return (
    <p class="sides">
      <TeamLink name={left} />
      <span class="between">{stands ? stands.map(written).join(" : ") : "–"}</span>
      <TeamLink name={right} />
    </p>
  );
}

/** The score of a running game's match, in the order of its teams; null before its first result. */
function stands(
  sheet: ContestSheet,
  pairing: string,
  teams: readonly [string, string],
): readonly [number, number] | null {
  const played = found(sheet, pairing);
  const points = played && score(played.match, played.view);
  if (!points) return null;
  return played.match.teams[0] === teams[0] ? points : [points[1], points[0]];
}
