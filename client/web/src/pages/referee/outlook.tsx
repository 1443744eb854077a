/** What would happen if play went on: the court lets a copy of the match go on, nothing changes. */

import { useSignal } from "@preact/signals";
import type { Phrase } from "../../core/phrase";
import { BEATS_PER_S, type Decision, type Outlook as Found, Phase } from "../../core/wire";
import { said, t } from "../../i18n";
import { type Desk, reasonOf } from "./desk";

interface Props {
  desk: Desk;
  /** What would be decided before play goes on; null: nothing. */
  decision: Decision | null;
}

type State = { is: "unasked" } | { is: "asked" } | { is: "told"; found: Found } | Refusal;
interface Refusal {
  is: "refused";
  why: Phrase | string;
}

/** A button that asks, and the court's answer below it; only during a halt. */
export function Outlook({ desk, decision }: Props) {
  if (desk.phase.value !== Phase.HALTED || desk.closed()) return null;
  // An answer holds only until the next event or decision, and for this decision.
  const about = JSON.stringify([desk.court.events.value.at(-1)?.number, decision]);
  return <Asking key={about} desk={desk} decision={decision} />;
}

function Asking({ desk, decision }: Props) {
  const state = useSignal<State>({ is: "unasked" });
  const ask = async () => {
    state.value = { is: "asked" };
    try {
      state.value = { is: "told", found: await desk.lookAhead(decision) };
    } catch (error) {
      state.value = { is: "refused", why: reasonOf(error) };
    }
  };
  const now = state.value;
  return (
    <div class="outlook" aria-live="polite">
      {now.is === "unasked" && (
        <button class="button" type="button" title={t("outlook.help")} onClick={ask}>
          {t(decision ? "outlook.askAfter" : "outlook.ask")}
        </button>
      )}
      {now.is === "asked" && <p class="muted">{t("outlook.playing")}</p>}
      {now.is === "refused" && <p class="refused">{said(now.why)}</p>}
      {now.is === "told" && <Told found={now.found} />}
    </div>
  );
}

function Told({ found }: { found: Found }) {
  return (
    <div class="preview">
      <p>{t("outlook.title", { seconds: found.seconds })}</p>
      <dl class="scores">
        <dt>{t("outlook.before")}</dt>
        <dd>{found.before.join(" : ")}</dd>
        <dt>{t("outlook.then")}</dt>
        <dd class="then">{found.scores.join(" : ")}</dd>
      </dl>
      {found.events.length ? (
        <ul>
          {found.events.map((event) => (
            <li key={event.number}>
              {t("outlook.after", {
                seconds: ((event.clock_ticks - found.clock_ticks) / BEATS_PER_S).toFixed(1),
              })}{" "}
              {said(event.said)}
            </li>
          ))}
        </ul>
      ) : (
        <p class="muted">{t("outlook.nothing")}</p>
      )}
      <p class="muted">{t("outlook.help")}</p>
    </div>
  );
}
