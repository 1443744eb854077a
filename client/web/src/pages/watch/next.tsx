/** After a game of an event: who won a level match, and when and where its teams play again. */

import { eventFeed } from "../../core/contest/feed";
import { matchOf, nextGameOf } from "../../core/contest/games";
import { type ContestSheet, howEnded, stateOf } from "../../core/contest/sheet";
import type { Court } from "../../core/court";
import { t } from "../../i18n";
import { expected } from "../contest/words";

export function NextOfTeams({ court }: { court: Court }) {
  const sheet = eventFeed.sheet.value;
  const played = court.sheet.value;
  if (!sheet || !played) return null;
  const decided = <Decided court={court} />;
  if (stateOf(sheet) === "over") {
    return (
      <>
        {decided}
        <p>{t("event.over")}</p>
      </>
    );
  }
  return (
    <>
      {decided}
      {played.seats.map(({ team }) => (
        <Next key={team} sheet={sheet} team={team} call={played.call} />
      ))}
    </>
  );
}

/** Why a match has a winner although its games are level. */
export function Decided({ court }: { court: Court }) {
  const sheet = eventFeed.sheet.value;
  const played = court.sheet.value;
  const match = sheet && played && matchOf(sheet, played.match_id);
  const how = match && howEnded(match);
  if (!match?.winner || (how !== "difference" && how !== "seed")) return null;
  return <p>{t("event.goesTo", { team: match.winner, how: t(`contest.how.${how}`) })}</p>;
}

function Next({ sheet, team, call }: { sheet: ContestSheet; team: string; call: string }) {
  const game = nextGameOf(sheet, team, call);
  if (!game) return null;
  const [left, right] = game.teams;
  const when = game.call ? t("contest.court", { court: game.court }) : expected(sheet, game);
  return (
    <p>
      {t("event.plays", { team, opponent: left === team ? right : left })}
      {when && ` · ${when}`}
    </p>
  );
}
