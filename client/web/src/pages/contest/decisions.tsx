/** What people decided, with the reasons: everybody can read them. */

import { type ContestSheet, found } from "../../core/contest/sheet";
import { said, t } from "../../i18n";
import { dateTime } from "../../i18n/words";
import { matchId } from "./parts";

export function Decisions({ sheet }: { sheet: ContestSheet }) {
  if (!sheet.decided.length) return null;
  const unused = new Map(sheet.unused.map(({ fact, why }) => [fact, why]));
  return (
    <section id="decisions" aria-labelledby="decisions-title">
      <h2 id="decisions-title">{t("contest.decisions")}</h2>
      <ul class="decisions">
        {sheet.decided.map(({ fact, at_ms, what, pairing, reason }) => {
          const place = found(sheet, pairing);
          const why = unused.get(fact);
          return (
            <li key={fact}>
              <p class="muted when">{dateTime(at_ms)}</p>
              <p>
                <b>{said(what)}</b>{" "}
                {place && <a href={`#${matchId(place.match)}`}>{t("contest.toMatch")}</a>}
              </p>
              {reason && <p>{t("contest.reason", { reason })}</p>}
              {why && <p class="muted">{t("contest.changesNothing", { why: said(why) })}</p>}
            </li>
          );
        })}
      </ul>
    </section>
  );
}
