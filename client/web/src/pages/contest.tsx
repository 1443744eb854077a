/** The contest: what is played now, tables, bracket, results and replays, for everybody. */

import { effect } from "@preact/signals";
import { useEffect } from "preact/hooks";
import { eventFeed as feed } from "../core/contest/feed";
import {
  type ContestSheet,
  isKnockout,
  type Planned,
  type StageView,
  stateOf,
} from "../core/contest/sheet";
import { said, t } from "../i18n";
import { NoticeBanner } from "../ui/banner";
import { useIsBefore } from "../ui/moment";
import { Big } from "./contest/big";
import { BracketView } from "./contest/bracket";
import { Decisions } from "./contest/decisions";
import { Head, Parts } from "./contest/head";
import { Now } from "./contest/now";
import { addressed, big } from "./contest/parts";
import { Reasons } from "./contest/reasons";
import { Schedule } from "./contest/schedule";
import { Tables, Ties } from "./contest/standings";
import { TeamDialog, Teams } from "./contest/teams";
import { expected, roundsLeft, stageHeading, stageTitle, whoTitle } from "./contest/words";
import "./contest/contest.css";

effect(() => {
  document.title = `${feed.sheet.value?.name || t("contest.title")} – LACOC`;
});

export default function Contest() {
  useEffect(() => feed.start(), []);
  const sheet = feed.sheet.value;
  const trouble = feed.trouble.value;
  useIsBefore(sheet?.day.until_ms ?? 0); // then expected times are no longer "not before"
  return (
    <>
      {trouble && sheet && (
        <p class="banner" role="alert">
          {t(`contest.trouble.${trouble}`)}
        </p>
      )}
      {sheet && !trouble && (
        <NoticeBanner notice={{ text: sheet.announced?.text ?? "", ...sheet.day }} />
      )}
      {sheet && (big ? <Big sheet={sheet} /> : <Whole sheet={sheet} />)}
      {!sheet && (
        <main class="contest none">
          <h1>{t("contest.title")}</h1>
          <p role="status">{t(trouble ? `contest.trouble.${trouble}` : "contest.loading")}</p>
        </main>
      )}
    </>
  );
}

/** Go to the part that the address names: the browser looked for it before it was there. */
function showAddressed(): void {
  const part = document.getElementById(addressed.peek());
  part?.closest("details")?.setAttribute("open", "");
  part?.scrollIntoView();
}

function Whole({ sheet }: { sheet: ContestSheet }) {
  useEffect(showAddressed, []);
  return (
    <main class="contest">
      <Head sheet={sheet} />
      <Parts sheet={sheet} />
      {stateOf(sheet) !== "over" && <Now sheet={sheet} />}
      {sheet.stages.toReversed().map((view) => (
        <Stage key={view.stage.name} sheet={sheet} view={view} />
      ))}
      {sheet.planned.map((plan) => (
        <ToCome key={plan.stage} sheet={sheet} plan={plan} />
      ))}
      <Teams sheet={sheet} />
      <Decisions sheet={sheet} />
      <Unused sheet={sheet} />
      <TeamDialog sheet={sheet} />
    </main>
  );
}

function Stage({ sheet, view }: { sheet: ContestSheet; view: StageView }) {
  const { name } = view.stage;
  return (
    <section id={`stage-${name}`} class="stage" aria-labelledby={`title-${name}`}>
      <h2 id={`title-${name}`}>
        {stageTitle(sheet, name)} <small>{stageHeading(sheet, view.plan)}</small>
      </h2>
      {isKnockout(view) && (
        <div class="scrolls wide">
          <BracketView sheet={sheet} view={view} />
        </div>
      )}
      <Reasons sheet={sheet} view={view} />
      <Tables view={view} />
      <Ties view={view} />
      {view.rounds_to_draw > 0 && <p class="muted">{roundsLeft(view)}</p>}
      <Schedule sheet={sheet} view={view} />
    </section>
  );
}

/** A stage that is not drawn yet. */
function ToCome({ sheet, plan }: { sheet: ContestSheet; plan: Planned }) {
  const { stage, after, draw, teams } = plan;
  const follows = draw === "organiser" ? "contest.plannedByHand" : "contest.plannedAfter";
  return (
    <section class="stage" aria-labelledby={`title-${stage}`}>
      <h2 id={`title-${stage}`}>
        {stageTitle(sheet, stage)} <small>{stageHeading(sheet, plan)}</small>
      </h2>
      <Later sheet={sheet} stage={stage} />
      <p class="muted">
        {after ? t(follows, { stage: stageTitle(sheet, after) }) : t("contest.planned")}{" "}
        {!!teams && t("contest.best", { count: teams })}
      </p>
    </section>
  );
}

/** The matches that a stage will have, with what is known of them. */
function Later({ sheet, stage }: { sheet: ContestSheet; stage: string }) {
  const matches = sheet.later.filter((one) => one.stage === stage);
  if (!matches.length) return null;
  return (
    <ol class="coming">
      {matches.map(({ pairing, fixture, who, court, at_ms }) => (
        <li key={pairing}>
          <b>{said(fixture)}</b>
          <p class="muted">{whoTitle(who)}</p>
          <p class="expected">{expected(sheet, { court, at_ms })}</p>
        </li>
      ))}
    </ol>
  );
}

/** What was written down and does not count, and why. */
function Unused({ sheet }: { sheet: ContestSheet }) {
  if (!sheet.unused.length) return null;
  return (
    <details class="unused">
      <summary>{t("contest.unused")}</summary>
      <ul>
        {sheet.unused.map(({ fact, why }) => (
          <li key={fact}>{said(why)}</li>
        ))}
      </ul>
    </details>
  );
}
