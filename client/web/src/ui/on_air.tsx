/** What the director shows: which court is on air and why, and the latest results between matches. */

import { useMemo } from "preact/hooks";
import type { Court } from "../core/court";
import { phaseOf } from "../core/match";
import { Phase, type Programme, type ShownResult } from "../core/wire";
import { type MessageName, said, t } from "../i18n";
import "./on_air.css";

const BETWEEN = new Set<number>([Phase.CREATED, Phase.LOBBY, Phase.READY]);

/** The court on air and the reason; nothing without a director, and before it begins. */
export function OnAir({ court }: { court: Court }) {
  const programme = court.programme.value;
  if (!programme || programme.begins_s > 0) return null;
  return <Shown programme={programme} label={t("director.onAir")} />;
}

/** Which court a picture shows, and why. */
export function Shown({ programme, label }: { programme: Programme; label: string }) {
  const why = programme.why && t(`director.why.${programme.why}` as MessageName);
  return (
    <p
      key={`${programme.court}/${programme.why}`}
      class="on-air"
      data-court={programme.court}
      data-why={programme.why}
    >
      <b>{label}</b>
      <span>
        {t("director.court", { court: programme.court })}
        {why && <span class="why"> · {why}</span>}
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
