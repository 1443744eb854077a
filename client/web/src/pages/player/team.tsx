/** The card of a token: asks for it, and says when, where and against whom its team plays next. */

import { useSignal } from "@preact/signals";
import type { Court } from "../../core/court";
import type { Team } from "../../core/team";
import { said, sentence, t } from "../../i18n";
import { RulesLink } from "../../ui/rules_link";

/** What is said of a team that has played to its end. */
const PLAYED: ReadonlySet<string> = new Set(["team.out", "team.over"]);

interface Props {
  court: Court;
  team: Team;
}

export function TeamCard({ court, team }: Props) {
  const contest = court.welcome.value?.contest;
  if (!team.isOn.value) return <TokenCard contest={contest} team={team} />;
  const there = team.there.value;
  if (!there) {
    return (
      <section class="card entrance" aria-labelledby="entrance-title">
        <h1 id="entrance-title">{t("team.asking")}</h1>
        <span class="spinner" aria-hidden="true" />
      </section>
    );
  }
  const isOver = team.isOver.value;
  const refusal = team.unseated.value;
  const own = `contest#team=${encodeURIComponent(there.team)}`;
  return (
    <section class="card entrance" aria-labelledby="entrance-title" data-state={there.state}>
      <div>
        {contest && <p class="muted">{contest}</p>}
        <h1 id="entrance-title">{there.team}</h1>
      </div>
      <div role="status" class="coming">
        {there.news && <p>{said(there.news)}</p>}
        {!isOver && <p>{t("team.nextMatch")}</p>}
        {PLAYED.has(there.said.code) && <p>{t("team.thanks")}</p>}
        <strong>{said(there.said)}</strong>
        {there.state === "waits" && there.opponent && there.fixture && <p>{said(there.fixture)}</p>}
        {Boolean(there.games_before) && (
          <p class="muted">{t("team.before", { count: Number(there.games_before) })}</p>
        )}
      </div>
      {refusal && (
        // The page asks again by itself; whoever stands beside it must know what to wait for.
        <p class="error" role="alert">
          {sentence(refusal.why)}
        </p>
      )}
      {team.driven.value && (
        <>
          <p role="alert">{t("team.driven", { team: there.team })}</p>
          <button class="button strong" type="button" onClick={() => team.takeOver()}>
            {t("team.takeOver")}
          </button>
        </>
      )}
      {isOver || team.driven.value ? (
        <p class="row">
          {isOver && contest && (
            <a class="button strong" href={own}>
              {t("team.matches")}
            </a>
          )}
          {there.state !== "over" && (
            <a class="button" href={`watch${location.search}`}>
              {t("watching.watch")}
            </a>
          )}
        </p>
      ) : (
        <p class="muted">{t("team.byItself")}</p>
      )}
      <p class="ways">
        {contest && !isOver && <a href={own}>{t("team.matches")}</a>}
        {contest && <a href="contest">{t("team.tables")}</a>}
        <RulesLink />
      </p>
      {court.welcome.value?.desk && !isOver && (
        <a class="button quiet small" href="enter">
          {t("team.files")}
        </a>
      )}
      <button class="button quiet small" type="button" onClick={() => team.forget()}>
        {t("team.other")}
      </button>
    </section>
  );
}

/** Nobody has given a token here yet. */
function TokenCard({ contest, team }: { contest: string | undefined; team: Team }) {
  const token = useSignal("");
  const { refusal } = team;
  const submit = (event: Event) => {
    event.preventDefault();
    if (token.value.trim()) team.enter(token.value.trim());
    else document.getElementById("team-token")?.focus();
  };
  return (
    <form class="card entrance" aria-labelledby="entrance-title" onSubmit={submit}>
      <h1 id="entrance-title">{t("team.title")}</h1>
      {contest && <p class="muted">{contest}</p>}
      <p>{t("team.text")}</p>
      <label class="field">
        <span>{t("team.token")}</span>
        <input
          id="team-token"
          value={token.value}
          autocomplete="off"
          spellcheck={false}
          aria-invalid={refusal.value !== null}
          aria-describedby="team-token-error"
          onInput={(event) => {
            token.value = event.currentTarget.value;
          }}
        />
        <p class="error" id="team-token-error" role="alert">
          {refusal.value && sentence(refusal.value.why)}
        </p>
      </label>
      <button class="button strong large" type="submit">
        {t("team.go")}
      </button>
    </form>
  );
}
