/** Before play: the teams, who is still missing, the game; then the countdown. */

import { computed } from "@preact/signals";
import { useMemo } from "preact/hooks";
import { type Match, phaseOf } from "../core/match";
import { Phase, SeatFlag, type Sheet } from "../core/wire";
import { t } from "../i18n";
import { BEATS_PER_S, clock, clockTicks, hint, played, ruleOf, team } from "../i18n/words";
import { isLast, SeatMark } from "./score";
import "./opening.css";

const WAITING = new Set<number>([Phase.CREATED, Phase.LOBBY, Phase.READY]);
/** How long "Go" is shown. */
const GO_TICKS = 0.9 * BEATS_PER_S;

/** True if the card is shown, low in the picture. */
export function useOpening(match: Match): boolean {
  const phase = useMemo(() => phaseOf(match), [match]).value;
  const seats = match.sheet.value?.seats.length ?? 0;
  return WAITING.has(phase) && seats > 1;
}

/** The two teams while a match is being prepared; nothing afterwards. */
export function OpeningCard({ match }: { match: Match }) {
  const shown = useOpening(match);
  const flags = useMemo(
    () => computed(() => match.frame.value?.seats.map((seat) => seat.flags).join(" ") ?? ""),
    [match],
  ).value;
  const next = useMemo(() => computed(() => hint(match)), [match]).value;
  const sheet = match.sheet.value;
  if (!shown || !sheet || !flags) return null;
  const rule = ruleOf(sheet);
  return (
    <section class="opening" aria-label={t("opening.title")}>
      <p class="kicker">
        {played(sheet)}
        {sheet.duration_s > 0 && ` · ${clock(sheet.duration_s * BEATS_PER_S)}`}
      </p>
      <div class="meeting">
        {flags.split(" ").map((flag, index) => (
          <Side key={index} sheet={sheet} index={index} flags={Number(flag)} />
        ))}
      </div>
      <p class="next">{next}</p>
      {rule && <p class="rules">{rule}</p>}
    </section>
  );
}

function Side({ sheet, index, flags }: { sheet: Sheet; index: number; flags: number }) {
  const joined = flags & SeatFlag.JOINED;
  const ready = joined && flags & SeatFlag.READY;
  const state = ready ? "opening.ready" : joined ? "opening.joined" : "seat.nobody";
  return (
    <div class={`side${joined ? "" : " away"}`} data-seat={index}>
      <SeatMark sheet={sheet} index={index} />
      <span class="name">{team(sheet, index)}</span>
      <span class={`state${ready ? " ready" : ""}`}>{t(state)}</span>
    </div>
  );
}

/** The seconds to the start, large; then "Go"; and the last ten seconds of play. */
export function Countdown({ match }: { match: Match }) {
  const shown = useMemo(
    () =>
      computed(() => {
        const frame = match.frame.value;
        if (frame?.phase === Phase.COUNTDOWN) {
          return String(Math.max(1, Math.ceil(frame.countdown_beats / BEATS_PER_S)));
        }
        const sheet = match.sheet.value;
        if (frame?.phase !== Phase.PLAYING || !sheet) return "";
        if (isLast(frame, sheet)) {
          return `last ${Math.max(1, Math.ceil(clockTicks(frame, sheet) / BEATS_PER_S))}`;
        }
        const begun = match.events.value.findLast(({ data }) => data.after === "PLAYING");
        return begun && frame.beat >= begun.beat && frame.beat - begun.beat < GO_TICKS ? "go" : "";
      }),
    [match],
  ).value;
  if (!shown) return null;
  const last = shown.startsWith("last ");
  return (
    // The clock beside it says the last seconds to a screen reader, at its own times.
    <div
      class={last ? "countdown last" : "countdown"}
      role="status"
      aria-hidden={last || undefined}
      key={shown}
    >
      {shown === "go" ? t("countdown.go") : shown.replace("last ", "")}
    </div>
  );
}
