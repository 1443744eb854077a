/** The matches of a stage, round by round, with their results. */

import {
  type ContestMatch,
  type ContestSheet,
  countsGames,
  howEnded,
  isDecided,
  type Round,
  rounds,
  type StageView,
  score,
  seating,
  written,
} from "../../core/contest/sheet";
import { t } from "../../i18n";
import { addressed, chosenTeam, GameScore, matchId, TeamLink } from "./parts";
import { courtOf, expectedOf, numberTitle, originTitle, scheduleTitle } from "./words";

/** With more matches than this, only the current round is open. */
const OPEN_MOST = 60;

interface Props {
  sheet: ContestSheet;
  view: StageView;
}

export function Schedule({ sheet, view }: Props) {
  const all = rounds(view);
  const few = view.matches.length <= OPEN_MOST;
  const current = all.find(({ matches }) => !matches.every(isDecided)) ?? all.at(-1);
  return (
    <div class="schedule">
      <h3>{t("contest.schedule")}</h3>
      {all.map((round) => (
        <OneRound
          key={round.section + round.round}
          sheet={sheet}
          view={view}
          round={round}
          open={few || round === current}
        />
      ))}
      {view.matches.some(({ games = [] }) => games.some(({ ruled }) => ruled)) && (
        <p class="muted">{t("contest.ruledMark")}</p>
      )}
    </div>
  );
}

function OneRound({ sheet, view, round, open }: Props & { round: Round; open: boolean }) {
  const done = round.matches.filter(isDecided).length;
  return (
    <details open={open} class="round">
      <summary>
        <b>{scheduleTitle(view, round)}</b>{" "}
        <span class="muted">{t("contest.done", { done, all: round.matches.length })}</span>
      </summary>
      <ul class="matches">
        {round.matches.map((match) => (
          <MatchRow key={match.pairing.id} sheet={sheet} view={view} match={match} id />
        ))}
      </ul>
    </details>
  );
}

interface RowProps extends Props {
  match: ContestMatch;
  /** Whether other parts of the page lead here. */
  id?: boolean;
  /** What stands before the match; by default its group, or its number in a bracket. */
  label?: string | undefined;
}

/** A match: its teams with the score between them, and its games. */
export function MatchRow({ sheet, view, match, id = false, label }: RowProps) {
  const [one, other] = seating(match);
  const points = score(match, view);
  const how = howEnded(match);
  const games = match.games ?? [];
  // Points of a game stand in the order in which the row names the teams.
  const shown: ContestMatch = { ...match, teams: [match.teams[one], match.teams[other]] };
  const many = countsGames(match, view) && games.length > 0;
  const court = courtOf(sheet.running, match);
  const when = isDecided(match) || court ? "" : expectedOf(sheet, match.pairing.id);
  const group = view.tables.length > 1 ? match.pairing.section.toUpperCase() : "";
  const wanted = chosenTeam.value
    ? match.teams.includes(chosenTeam.value)
    : addressed.value === matchId(match);
  return (
    <li
      id={id ? matchId(match) : undefined}
      class="match"
      data-state={court ? "running" : match.state}
      data-chosen={(id && wanted) || undefined}
    >
      <span class="label">{label ?? (group || numberTitle(view, match))}</span>
      <Place sheet={sheet} match={match} place={one} />
      <span class="score">
        {points && many && `${written(points[one])} : ${written(points[other])}`}
        {points && !many && <GameScore match={shown} game={games[0]!} />}
        {!points && "–"}
      </span>
      <Place sheet={sheet} match={match} place={other} />
      <span class="notes">
        {court && <b class="live">{t("contest.on", { court })}</b>}
        {when && <span class="expected">{when}</span>}
        {how && <span>{t(`contest.how.${how}`)}</span>}
        {match.pairing.only_if_second_won && !games.length && <span>{t("contest.ifNeeded")}</span>}
        {many && (
          <span class="games">
            {games.map((game) => (
              <GameScore key={game.number} match={shown} game={game} />
            ))}
          </span>
        )}
      </span>
    </li>
  );
}

interface PlaceProps {
  sheet: ContestSheet;
  match: ContestMatch;
  place: 0 | 1;
}

/** The team of a place, or where it will come from. */
function Place({ sheet, match, place }: PlaceProps) {
  const team = match.teams[place];
  if (team) return <TeamLink name={team} won={isDecided(match) && match.winner === team} />;
  const text = team === null ? originTitle(sheet, match.pairing.sources[place]) : "–";
  return <span class="team muted">{text}</span>;
}
