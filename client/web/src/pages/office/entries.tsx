/** The entries: who waits, who is in, and what is wrong with files that were refused. */

import { useSignal } from "@preact/signals";
import type { OfficeView, TeamRow } from "../../core/desk";
import { t } from "../../i18n";
import { Mistakes } from "../../ui/mistakes";
import type { Organiser } from "./organiser";

interface Props {
  organiser: Organiser;
  view: OfficeView;
  /** Whether only teams are shown that wait for the organiser. */
  waiting?: boolean;
}

/** With more teams than this, the list can be searched. */
const FEW = 12;

export function Entries({ organiser, view, waiting = false }: Props) {
  const wanted = useSignal("");
  const rows = waiting ? organiser.waiting.value : view.teams;
  const shown = rows.filter(({ team }) => matches(team, wanted.value));
  const title = waiting ? "waiting-title" : "entries-title";
  const fresh = organiser.waiting.value.filter(({ state }) => state === "waits");
  return (
    <section class="entries" aria-labelledby={title}>
      <div class="bar">
        <h2 id={title}>{t(waiting ? "office.waiting" : "office.entries")}</h2>
        {rows.length > FEW && (
          <input
            type="search"
            aria-label={t("office.find")}
            placeholder={t("office.find")}
            value={wanted.value}
            onInput={(event) => {
              wanted.value = event.currentTarget.value;
            }}
          />
        )}
        {fresh.length > 0 && view.event.open && (
          <button
            class="button strong"
            type="button"
            onClick={() =>
              void organiser.do({ do: "approve", teams: fresh.map(({ team }) => team) })
            }
          >
            {t("office.approveAll", { count: fresh.length })}
          </button>
        )}
        {fresh.length > 1 && (
          <button
            class="button quiet"
            type="button"
            onClick={() => {
              organiser.over.value = { is: "decline", teams: fresh.map(({ team }) => team) };
            }}
          >
            {t("office.declineAll", { count: fresh.length })}
          </button>
        )}
      </div>
      {!view.teams.length && <p class="muted">{t("office.noTeams")}</p>}
      <ul>
        {shown.map((row) => (
          <Row key={row.team} organiser={organiser} row={row} open={view.event.open} />
        ))}
      </ul>
    </section>
  );
}

interface RowProps {
  organiser: Organiser;
  row: TeamRow;
  /** Whether entries are open. */
  open: boolean;
}

function Row({ organiser, row, open }: RowProps) {
  const { team, state, files, bot, mistakes } = row;
  const approve = () => {
    if (state === "late" || !open) organiser.over.value = { is: "approve", team };
    else void organiser.do({ do: "approve", teams: [team] });
  };
  return (
    <li data-state={state}>
      <button
        type="button"
        class="team"
        onClick={() => {
          organiser.over.value = { is: "team", team };
        }}
      >
        {team}
      </button>
      <span class="state">{stateOf(row)}</span>
      <span class="about muted">
        {bot && t("office.bot", { bot })}
        {files && <code title={t("office.hash")}>{files.slice(0, 8)}</code>}
      </span>
      <span class="acts">
        {(state === "late" || state === "waits") && (
          <button
            class="button"
            type="button"
            aria-label={t("office.approveOf", { team })}
            onClick={approve}
          >
            {t("office.approve")}
          </button>
        )}
        {state === "withdrawn" && open && (
          <button
            class="button"
            type="button"
            aria-label={t("office.bringBackOf", { team })}
            onClick={() => void organiser.do({ do: "approve", teams: [team] })}
          >
            {t("office.bringBack")}
          </button>
        )}
        {(state === "waits" || state === "late" || state === "refused") && (
          <button
            class="button quiet"
            type="button"
            aria-label={t("office.declineOf", { team })}
            onClick={() => {
              organiser.over.value = { is: "decline", teams: [team] };
            }}
          >
            {t("office.decline")}
          </button>
        )}
      </span>
      {mistakes.length > 0 && (
        <details>
          <summary>{t("office.mistakes", { count: mistakes.length })}</summary>
          <Mistakes mistakes={mistakes} />
        </details>
      )}
    </li>
  );
}

/** How a team's entry stands. */
export function stateOf({ state, replaced_by }: TeamRow): string {
  if (state === "withdrawn" && replaced_by) {
    return t("office.state.replaced", { substitute: replaced_by });
  }
  return t(`office.state.${state}`);
}

/** Whether a name contains what is searched for. */
export function matches(name: string, wanted: string): boolean {
  const plain = (text: string) => text.normalize("NFKC").toLocaleLowerCase();
  return plain(name).includes(plain(wanted.trim()));
}
