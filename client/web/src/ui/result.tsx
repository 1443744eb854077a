/** How a match ended: by the rules first, then officially. */

import { computed } from "@preact/signals";
import { useMemo } from "preact/hooks";
import { type Match, phaseOf } from "../core/match";
import type { Phrase } from "../core/phrase";
import { type Event, Phase, type Sheet } from "../core/wire";
import { said, t } from "../i18n";
import { byRules, clock, team, winnerOf } from "../i18n/words";
import { SeatMark } from "./score";
import "./result.css";

const SHOWN = new Set<number>([Phase.FINISHED, Phase.OFFICIAL, Phase.VOID]);

interface Props {
  match: Match;
  /** There is a way to put the card away. */
  onClose?: () => void;
}

/** Nothing until the match is over. */
export function ResultCard({ match, onClose }: Props) {
  const phase = useMemo(() => phaseOf(match), [match]).value;
  const scores = useMemo(
    () => computed(() => match.frame.value?.seats.map((seat) => seat.score).join(" ") ?? ""),
    [match],
  ).value;
  const sheet = match.sheet.value;
  const frame = match.frame.peek();
  const winner = winnerOf(match);
  const isVoid = phase === Phase.VOID;
  if (!SHOWN.has(phase) || !sheet || !frame || (!isVoid && winner === null)) return null;
  const events = match.events.value;
  const official = phase === Phase.OFFICIAL;
  const declared = !isVoid && byRules(events) !== winner;
  const kicker = isVoid
    ? "result.void"
    : official
      ? "result.official"
      : declared
        ? "result.declared"
        : "result.byRules";
  return (
    <section class="result" data-phase={phase} aria-label={t("result.title")} aria-live="polite">
      <p class="kicker">{t(kicker)}</p>
      <h1>{isVoid ? t("hint.void") : title(sheet, winner)}</h1>
      {sheet.seats.length > 1 && (
        <div class="final">
          {scores.split(" ").map((score, index) => (
            <div
              key={index}
              class={`side${!isVoid && sheet.seats[index]?.id === winner ? " won" : ""}`}
              data-seat={index}
            >
              <span class="who">
                <SeatMark sheet={sheet} index={index} />
                <span class="name">{team(sheet, index)}</span>
              </span>
              <span class="points">{score}</span>
            </div>
          ))}
        </div>
      )}
      <p class="why">{why(events, clock(frame.clock_ticks))}</p>
      {official && declared && <p class="why">{t("result.declared")}</p>}
      <p class="next">{t(phase === Phase.FINISHED ? "hint.finished" : "result.next")}</p>
      {onClose && (
        <button class="button quiet" type="button" onClick={onClose}>
          {t("result.close")}
        </button>
      )}
    </section>
  );
}

function title(sheet: Sheet, winner: string | null): string {
  if (winner === "draw") return t("hint.draw");
  const index = sheet.seats.findIndex((seat) => seat.id === winner);
  return t("hint.wins", { team: team(sheet, index) });
}

/** Why play ended, and after how long. */
function why(events: readonly Event[], time: string): string {
  const end = events.findLast(({ data }) => data.after === "FINISHED" || data.after === "VOID");
  const reason = end?.said.values?.why as Phrase | undefined;
  return reason ? t("result.ended", { reason: said(reason), time }) : t("result.time", { time });
}
