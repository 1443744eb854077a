/** The health of the court: a verdict in one word, and its numbers. */

import { useSignal } from "@preact/signals";
import { useEffect } from "preact/hooks";
import type { Phrase } from "../../core/phrase";
import { canPlayAgain } from "../../core/rulings";
import type { Health } from "../../core/wire";
import { said, t } from "../../i18n";
import type { Desk } from "./desk";

export type VerdictName = "good" | "watch" | "bad" | "unknown";

/** A verdict is a shape and a word; the colour only helps. */
const SHAPES: Record<VerdictName, string> = { good: "●", watch: "▲", bad: "■", unknown: "○" };

const LOOK_BACK_MS = 10_000;
const WATCH_FACTOR = 0.985;
const BAD_FACTOR = 0.95;

export function Verdict({ name, text }: { name: VerdictName; text: string }) {
  return (
    <span class={`verdict ${name}`}>
      <span aria-hidden="true">{SHAPES[name]}</span> {text}
    </span>
  );
}

export function HealthCard({ desk }: { desk: Desk }) {
  const { court } = desk;
  const recent = useRecentSlowBeats(desk);
  const health = court.live.value ? court.health.value : null;
  const name = verdict(health, recent);
  const dropped = Object.entries(health?.dropped ?? {});
  return (
    <section class="card health" aria-labelledby="health-title">
      <h2 id="health-title">{t("courtHealth.title")}</h2>
      <Verdict name={name} text={t(`courtHealth.${name}`)} />
      {health?.record_trouble && <p class="refused">{said(health.record_trouble)}</p>}
      <FoldedAdvice advice={adviceOf(health)} />
      {health && (
        <dl class="facts">
          <dt>{t("courtHealth.factor")}</dt>
          <dd>{health.real_time_factor.toFixed(2)}</dd>
          <dt>{t("courtHealth.slow")}</dt>
          <dd>
            {health.slow_beats}{" "}
            <span class="muted">({t("courtHealth.recent", { count: recent })})</span>
          </dd>
          <dt>{t("courtHealth.worst")}</dt>
          <dd>{Math.round(health.worst_late_ms)} ms</dd>
          <dt>{t("courtHealth.dropped")}</dt>
          <dd>
            {dropped.length
              ? dropped
                  .map(([why, count]) => `${count} × ${said({ code: `count.${why}` })}`)
                  .join(said({ code: "join.comma" }))
              : t("seatLink.nothingRefused")}
          </dd>
          <dt>{t("courtHealth.frames")}</dt>
          <dd>{t("courtHealth.perSecond", { hz: court.framesHz.value })}</dd>
        </dl>
      )}
    </section>
  );
}

interface AdviceProps {
  advice: readonly (Phrase | string)[];
}

/** Why the match should be played again; nothing where that can't be decided any more. */
export function adviceOf(health: Health | null): AdviceProps["advice"] {
  return health?.verdict && canPlayAgain(health.decisions) ? health.verdict.advice : [];
}

/** What the contest's limits say of this match so far; nothing while all is within them. */
export function Advice({ advice }: AdviceProps) {
  if (!advice.length) return null;
  return (
    <div class="advice" role="status">
      <h3>{t("courtHealth.advice")}</h3>
      <Reasons advice={advice} />
    </div>
  );
}

/** The same in one line that opens: the log below it needs the room. */
function FoldedAdvice({ advice }: AdviceProps) {
  if (!advice.length) return null;
  return (
    <details class="advice">
      <summary>{t("courtHealth.adviceCount", { count: advice.length })}</summary>
      <Reasons advice={advice} />
    </details>
  );
}

function Reasons({ advice }: AdviceProps) {
  return (
    <ul>
      {advice.map(said).map((reason) => (
        <li key={reason}>{reason}</li>
      ))}
    </ul>
  );
}

function verdict(health: Health | null, recent: number): VerdictName {
  if (!health) return "unknown";
  if (health.record_trouble || health.real_time_factor < BAD_FACTOR) return "bad";
  return health.real_time_factor < WATCH_FACTOR || recent > 0 ? "watch" : "good";
}

/** Slow beats of the last ten seconds; the court counts them from its start. */
function useRecentSlowBeats(desk: Desk): number {
  const counts = useSignal<{ atMs: number; slow: number }[]>([]);
  useEffect(
    () =>
      desk.court.health.subscribe((health) => {
        if (!health) return;
        const nowMs = performance.now();
        const kept = counts.peek().filter(({ atMs }) => atMs > nowMs - LOOK_BACK_MS);
        counts.value = [...kept, { atMs: nowMs, slow: health.slow_beats }];
      }),
    [desk, counts],
  );
  const first = counts.value[0]?.slow ?? 0;
  const last = counts.value[counts.value.length - 1]?.slow ?? 0;
  return Math.max(0, last - first);
}
