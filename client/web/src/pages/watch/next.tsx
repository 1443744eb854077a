/** After a match of an event: when and where its teams play again, as far as the office knows. */

import { eventFeed } from "../../core/contest/feed";
import { nextGameOf } from "../../core/contest/games";
import { type ContestSheet, stateOf } from "../../core/contest/sheet";
import type { Court } from "../../core/court";
import { t } from "../../i18n";
import { expected } from "../contest/words";

export function NextOfTeams({ court }: { court: Court }) {
  const sheet = eventFeed.sheet.value;
  const played = court.sheet.value;
  if (!sheet || !played) return null;
  if (stateOf(sheet) === "over") return <p>{t("event.over")}</p>;
  return (
    <>
      {played.seats.map(({ team }) => (
        <Next key={team} sheet={sheet} team={team} call={played.call} />
      ))}
    </>
  );
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
