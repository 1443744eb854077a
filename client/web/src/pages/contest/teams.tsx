/** All teams with their ratings, and one team's way through the contest. */

import { useSignal } from "@preact/signals";
import {
  type ContestSheet,
  equals,
  isKnockout,
  isStillIn,
  type Team,
  teamView,
} from "../../core/contest/sheet";
import { t } from "../../i18n";
import { Dialog } from "../../ui/dialog";
import { TeamPicture } from "../../ui/team_picture";
import { chooseNoTeam, chosenTeam, TeamLink } from "./parts";
import { MatchRow } from "./schedule";
import {
  expected,
  gameTitle,
  groupTitle,
  matchTitle,
  placeTitle,
  signed,
  stageTitle,
} from "./words";

export function Teams({ sheet }: { sheet: ContestSheet }) {
  const wanted = useSignal("");
  const found = ranked(sheet).filter(({ name }) =>
    name.toLocaleLowerCase().includes(wanted.value.trim().toLocaleLowerCase()),
  );
  return (
    <section id="teams" aria-labelledby="teams-title">
      <h2 id="teams-title">{t("contest.teams")}</h2>
      <label class="field find">
        <span>{t("contest.find")}</span>
        <input
          type="search"
          value={wanted.value}
          onInput={(event) => {
            wanted.value = event.currentTarget.value;
          }}
        />
      </label>
      {!found.length && <p role="status">{t("contest.noneFound")}</p>}
      {found.length > 0 && (
        <div class="scrolls">
          <Ratings sheet={sheet} teams={found} />
        </div>
      )}
      {sheet.ratings.length > 0 && (
        <p class="muted how">
          {t("contest.ratingHow")} {sideText(sheet)}
        </p>
      )}
    </section>
  );
}

/** The teams, the strongest first; those that have played no game follow. */
export function ranked(sheet: ContestSheet): Team[] {
  const place = new Map(sheet.ratings.map(({ team }, index) => [team, index]));
  const of = ({ name }: Team) => place.get(name) ?? place.size;
  return sheet.teams.toSorted((one, other) => of(one) - of(other));
}

interface RatingsProps {
  sheet: ContestSheet;
  teams: readonly Team[];
}

export function Ratings({ sheet, teams }: RatingsProps) {
  const ratings = new Map(sheet.ratings.map((rating) => [rating.team, rating]));
  return (
    <table class="standings ratings">
      <caption class="hidden-text">{t("contest.teams")}</caption>
      <thead>
        <tr>
          <th scope="col">
            <span class="hidden-text">{t("contest.rank")}</span>
          </th>
          <th scope="col" class="who">
            {t("contest.team")}
          </th>
          <th scope="col">{t("contest.rating")}</th>
          <th scope="col">
            <abbr title={t("contest.interval")}>±</abbr>
          </th>
          <th scope="col">{t("contest.games")}</th>
        </tr>
      </thead>
      <tbody>
        {teams.map((team) => {
          const rating = ratings.get(team.name);
          return (
            <tr key={team.name}>
              <td>{rating ? sheet.ratings.indexOf(rating) + 1 : ""}</td>
              <th scope="row" class="who">
                <TeamLink name={team.name} />
                <Marks team={team} />
              </th>
              <td class="points">{rating ? signed(Math.round(rating.elo)) : "–"}</td>
              <td>{rating ? Math.round(rating.interval_elo) : "–"}</td>
              <td>{rating?.games ?? 0}</td>
            </tr>
          );
        })}
      </tbody>
    </table>
  );
}

/** Which side has an advantage. */
export function sideText(sheet: ContestSheet): string {
  const elo = Math.round(Math.abs(sheet.side_elo));
  if (!elo) return t("contest.side.even");
  return t(sheet.side_elo > 0 ? "contest.side.left" : "contest.side.right", { elo });
}

/** What is special about a team. */
function Marks({ team }: { team: Team }) {
  const { substitute } = team;
  const left = substitute ? t("contest.replacedBy", { substitute }) : t("contest.withdrawn");
  return (
    <>
      {team.bot && <small class="mark"> {t("contest.bot", { bot: team.bot })}</small>}
      {team.disqualified && <small class="out"> {t("contest.out")}</small>}
      {team.withdrawn && !team.disqualified && <small class="out"> {left}</small>}
    </>
  );
}

/** One team: its places, its rating, and all its matches. */
export function TeamDialog({ sheet }: { sheet: ContestSheet }) {
  const shown = chosenTeam.value && teamView(sheet, chosenTeam.value);
  if (!shown) return null;
  const { team, ranks, matches, rating, rated, running, coming } = shown;
  return (
    <Dialog key={team.name} title={team.name} onClose={chooseNoTeam}>
      <div class="one-team">
        <TeamPicture sheet={sheet} team={team.name} />
        <Marks team={team} />
        <dl class="figures">
          {ranks.map(({ view, table, row }) => (
            <div key={view.stage.name}>
              <dt>
                {stageTitle(sheet, view.stage.name)} {groupTitle(view, table.section)}
              </dt>
              <dd>
                {isKnockout(view) && isStillIn(view, team.name)
                  ? t("contest.stillIn")
                  : placeTitle(row.rank, equals(table, row))}
                {row.out && ` (${t("contest.out")})`}
              </dd>
            </div>
          ))}
          {rating && (
            <div>
              <dt>{t("contest.rating")}</dt>
              <dd>
                {signed(Math.round(rating.elo))} ± {Math.round(rating.interval_elo)}{" "}
                <small class="muted">
                  {t("contest.ratedAs", { rank: rated, of: sheet.ratings.length })}
                </small>
              </dd>
            </div>
          )}
          {running && (
            <div>
              <dt>{t("contest.court", { court: running.court })}</dt>
              <dd>{gameTitle(sheet, running.pairing, running.game)}</dd>
            </div>
          )}
          {!running && coming && (
            <div>
              <dt>{t("contest.coming")}</dt>
              <dd>
                {gameTitle(sheet, coming.pairing, coming.game)}
                {expected(sheet, coming) && <small class="muted"> {expected(sheet, coming)}</small>}
              </dd>
            </div>
          )}
        </dl>
        <h3>{t("contest.path", { team: team.name })}</h3>
        {!matches.length && <p class="muted">{t("contest.noMatches")}</p>}
        <ul class="matches">
          {matches.map(({ view, match }) => (
            <MatchRow
              key={match.pairing.id}
              sheet={sheet}
              view={view}
              match={match}
              label={matchTitle(sheet, match.pairing.id)}
            />
          ))}
        </ul>
      </div>
    </Dialog>
  );
}
