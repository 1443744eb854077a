/** What the director shows: which court is on air and why, and the latest results between matches. */

import { useMemo } from "preact/hooks";
import type { Court } from "../core/court";
import { Cuts } from "../core/cuts";
import { phaseOf } from "../core/match";
import { Phase, type ShownResult } from "../core/wire";
import { type MessageName, said, t } from "../i18n";
import { fixtureOf } from "../i18n/words";
import "./on_air.css";

const BETWEEN = new Set<number>([Phase.CREATED, Phase.LOBBY, Phase.READY]);

interface OnAirProps {
  court: Court;
  /** Whether to say which match of the contest it is: the page says it nowhere else. */
  withMatch?: boolean;
  /** Whether the page shows the picture now. */
  isSeen?: boolean;
}

/** The court on air and the reason; nothing without a director, and before it begins. */
export function OnAir({ court, withMatch = false, isSeen = true }: OnAirProps) {
  const cuts = useMemo(() => new Cuts(), [court]);
  const phase = useMemo(() => phaseOf(court), [court]).value;
  const programme = court.programme.value;
  if (!programme || programme.begins_s > 0) return null;
  const { court: name } = programme;
  const why = cuts.why(programme, isSeen, phase);
  const fixture = withMatch && court.sheet.value ? fixtureOf(court.sheet.value) : "";
  return <Shown court={name} why={why} label={t("director.onAir")} fixture={fixture} />;
}

/** Which match of a contest a court plays, where only one court is there. */
export function OnlyMatch({ court }: { court: Court }) {
  const fixture = court.sheet.value && fixtureOf(court.sheet.value);
  return fixture ? (
    <p class="on-air" data-only>
      {fixture}
    </p>
  ) : null;
}

interface ShownProps {
  court: string;
  why: string;
  label: string;
  fixture?: string;
}

/** Which court a picture shows, and why. */
export function Shown({ court, why, label, fixture = "" }: ShownProps) {
  const reason = why && t(`director.why.${why}` as MessageName);
  return (
    <p key={`${court}/${why}`} class="on-air" data-court={court} data-why={why}>
      <b>{label}</b>
      <span>
        {t("director.court", { court })}
        {fixture && ` · ${fixture}`}
        {reason && <span class="why"> · {reason}</span>}
      </span>
    </p>
  );
}

/** The newest results of all courts, while the court on air waits for its next match. */
export function LatestResults({ court }: { court: Court }) {
  const phase = useMemo(() => phaseOf(court), [court]).value;
  const results = court.programme.value?.results ?? [];
  if (!results.length || !BETWEEN.has(phase)) return null;
  return (
    <section class="latest" aria-label={t("director.results")}>
      <h2>{t("director.results")}</h2>
      <ul>
        {results.map((result) => (
          <Row key={`${result.court}/${result.match}`} result={result} />
        ))}
      </ul>
    </section>
  );
}

function Row({ result }: { result: ShownResult }) {
  const [left, right] = result.teams;
  const isVoid = result.phase === Phase.VOID;
  return (
    <li>
      <p class="what">
        {result.fixture ? said(result.fixture) : result.title}
        {" · "}
        {t("director.court", { court: result.court })}
      </p>
      <p class="sides">
        <span>{left}</span>
        <b>{isVoid ? t("director.void") : result.scores.join(" : ")}</b>
        <span>{right}</span>
      </p>
    </li>
  );
}
