/** The head of the page: what the contest is, how it stands, and the ways to its parts. */

import { useSignal } from "@preact/signals";
import {
  type ContestSheet,
  champions,
  currentStage,
  progress,
  stateOf,
  teamsOf,
} from "../../core/contest/sheet";
import { t } from "../../i18n";
import { IconButton } from "../../ui/icons";
import { Settings } from "../../ui/settings";
import { TeamLink } from "./parts";
import { listed, stageTitle, winnersTitle } from "./words";

export function Head({ sheet }: { sheet: ContestSheet }) {
  const settings = useSignal(false);
  return (
    <header class="head">
      <div class="title">
        <h1>{sheet.name}</h1>
        <p class="state">
          <Standing sheet={sheet} />
        </p>
      </div>
      <div class="tools">
        <a class="button" href="?big">
          {t("contest.big")}
        </a>
        <button class="button" type="button" onClick={() => print()}>
          {t("contest.print")}
        </button>
        <IconButton
          name="settings"
          label={t("contest.settings")}
          onClick={() => {
            settings.value = true;
          }}
        />
      </div>
      <Winners sheet={sheet} />
      {settings.value && (
        <Settings
          onClose={() => {
            settings.value = false;
          }}
        />
      )}
    </header>
  );
}

/** How the contest stands, in a line. */
export function Standing({ sheet }: { sheet: ContestSheet }) {
  const state = stateOf(sheet);
  const current = state === "running" ? currentStage(sheet) : null;
  const { here, gone, replaced, expelled } = teamsOf(sheet);
  const parts = [
    current && stageTitle(sheet, current.stage.name),
    t("contest.teamCount", { count: here }),
    state !== "waiting" && t("contest.progress", progress(sheet)),
    // A projector cuts what is too long: names come last.
    ...replaced.map(({ name, substitute }) => t("contest.replaced", { team: name, substitute })),
    gone.length > 0 && t("contest.gone", { teams: listed(gone) }),
    expelled.length > 0 && t("contest.expelled", { teams: listed(expelled) }),
  ];
  return (
    <>
      <b class="badge" data-state={state}>
        {t(`contest.state.${state}`)}
      </b>{" "}
      {parts.filter(Boolean).join(" · ")}
    </>
  );
}

/** Who has won the contest. */
export function Winners({ sheet }: { sheet: ContestSheet }) {
  const winners = champions(sheet);
  if (!winners.length) return null;
  return (
    <p class="winner">
      <span>{winnersTitle(winners)}</span>{" "}
      {winners.map((name) => (
        <TeamLink key={name} name={name} />
      ))}
    </p>
  );
}

/** The ways to the parts of the page. */
export function Parts({ sheet }: { sheet: ContestSheet }) {
  return (
    <nav class="parts" aria-label={t("contest.parts")}>
      {stateOf(sheet) !== "over" && <a href="#now">{t("contest.now")}</a>}
      {sheet.stages.toReversed().map(({ stage }) => (
        <a key={stage.name} href={`#stage-${stage.name}`}>
          {stageTitle(sheet, stage.name)}
        </a>
      ))}
      <a href="#teams">{t("contest.teams")}</a>
      {sheet.decided.length > 0 && <a href="#decisions">{t("contest.decisions")}</a>}
    </nav>
  );
}
