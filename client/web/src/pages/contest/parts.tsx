/** Small parts that all sections of the page share: links to teams, scores, replays. */

import { computed, signal } from "@preact/signals";
import { flag } from "../../core/address";
import type { ContestMatch, CountedGame } from "../../core/contest/sheet";
import { replayAddress } from "../../core/record_files";
import { t } from "../../i18n";

const TEAM = "team=";
const hash = signal(location.hash);
addEventListener("hashchange", () => {
  hash.value = location.hash;
});

/** The part of the page that the address names: an element's id, or a team. */
export const addressed = computed(() => {
  try {
    return decodeURIComponent(hash.value.slice(1));
  } catch {
    return ""; // no address that this page wrote
  }
});

/** The team whose matches are shown; "" if none. */
export const chosenTeam = computed(() =>
  addressed.value.startsWith(TEAM) ? addressed.value.slice(TEAM.length) : "",
);

export function teamAddress(name: string): string {
  return `#${TEAM}${encodeURIComponent(name)}`;
}

/** Show no team any more. */
export function chooseNoTeam(): void {
  history.replaceState(null, "", location.pathname + location.search);
  hash.value = "";
}

/** Whether the page is a projector's: there nobody can press anything. */
export const big = flag("big", false);

interface TeamLinkProps {
  name: string;
  won?: boolean;
}

/** A team's name; it opens the team's matches. */
export function TeamLink({ name, won = false }: TeamLinkProps) {
  const kind = won ? "team won" : "team";
  if (big) return <span class={kind}>{name}</span>;
  return (
    <a class={kind} href={teamAddress(name)}>
      {name}
    </a>
  );
}

/** Names the element of a match, to which other parts of the page lead. */
export function matchId(match: ContestMatch): string {
  return `match-${match.pairing.id}`;
}

interface GameScoreProps {
  match: ContestMatch;
  game: CountedGame;
}

/** The points of a game by place of the match; they lead to its replay. */
export function GameScore({ match, game }: GameScoreProps) {
  const swapped = game.teams[0] !== match.teams[0];
  const [one, other] = swapped ? game.scores.toReversed() : game.scores;
  const [left, right] = game.teams;
  const points = (
    <>
      {one}
      <span class="colon">:</span>
      {other}
      {game.ruled && "*"}
    </>
  );
  const ruled = game.ruled ? t("contest.ruled") : "";
  const title = [t("contest.seats", { left, right }), ruled].filter(Boolean).join(" ");
  if (!game.record) return <span title={title}>{points}</span>;
  const label = t("contest.replayOf", { left, right, number: game.number });
  return (
    <a
      href={replayAddress(game.record)}
      title={title}
      aria-label={[`${one} : ${other}.`, ruled, label].filter(Boolean).join(" ")}
    >
      {points}
    </a>
  );
}
