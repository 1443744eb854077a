/** The score bug: the teams, the score, the clock and the phase; the same on every page. */

import { computed } from "@preact/signals";
import { useMemo } from "preact/hooks";
import { type Match, part, phaseOf } from "../core/match";
import { BEATS_PER_S, type Frame, Phase, SeatFlag, type Sheet } from "../core/wire";
import { t } from "../i18n";
import { clock, clockTicks, hint, seatState, team } from "../i18n/words";
import { TeamName } from "./team_name";

const LAST_TICKS = 10 * BEATS_PER_S;

/** A seat's letter on its colour and pattern. */
export function SeatMark({ sheet, index }: { sheet: Sheet; index: number }) {
  const seat = sheet.seats[index];
  return (
    <span class="seat-mark" data-seat={index} data-pattern={seat?.pattern} aria-hidden="true">
      {(seat?.id ?? "?").slice(0, 1).toUpperCase()}
    </span>
  );
}

export function ScoreBug({ match }: { match: Match }) {
  const begun = useMemo(() => part(match, () => true, false), [match]).value;
  const sheet = match.sheet.value;
  if (!sheet || !begun) return null;
  const solo = sheet.seats.length === 1;
  return (
    <div class={`score-bug${solo ? " solo" : ""}`}>
      <Team match={match} index={0} points={!solo} />
      <Middle match={match} />
      {!solo && <Team match={match} index={1} points />}
    </div>
  );
}

interface TeamProps {
  match: Match;
  index: number;
  points: boolean;
}

function Team({ match, index, points }: TeamProps) {
  const shown = useMemo(
    () =>
      computed(() => {
        const frame = match.frame.value;
        const seat = frame?.seats[index];
        return frame && seat ? [seat.flags, seat.score, seatState(frame, index)].join("|") : "";
      }),
    [match, index],
  );
  shown.value; // draw again only when one of these changes, not 50 times a second
  const sheet = match.sheet.value;
  const frame = match.frame.peek();
  const seat = frame?.seats[index];
  if (!sheet || !frame || !seat) return null;
  const joined = seat.flags & SeatFlag.JOINED;
  const state = joined ? seatState(frame, index) : t("seat.nobody");
  return (
    <div
      class={`team${joined && (!(seat.flags & SeatFlag.SILENT) || !state) ? "" : " away"}`}
      data-seat={index}
    >
      <SeatMark sheet={sheet} index={index} />
      <span class="name">
        <TeamName name={team(sheet, index)} />
        {state && <span class="state">{state}</span>}
      </span>
      {points && <span class="points">{seat.score}</span>}
    </div>
  );
}

function Middle({ match }: { match: Match }) {
  const shown = useMemo(
    () =>
      computed(() => {
        const { frame, sheet } = { frame: match.frame.value, sheet: match.sheet.value };
        return frame && sheet ? `${frame.phase}|${clock(clockTicks(frame, sheet))}` : "";
      }),
    [match],
  );
  const time = shown.value.split("|")[1];
  const frame = match.frame.peek();
  const sheet = match.sheet.peek();
  if (!frame || !sheet) return null;
  return (
    <div class="middle">
      <span class="hidden-text">{t(sheet.duration_s ? "clock.left" : "clock.played")}</span>
      <span class={`clock${isLast(frame, sheet) ? " last" : ""}`}>{time}</span>
      <PhaseWord match={match} />
    </div>
  );
}

/** The phase in a word. */
export function PhaseWord({ match }: { match: Match }) {
  const phase = useMemo(() => phaseOf(match), [match]).value;
  const sheet = match.sheet.value;
  // Practice: one seat, and no end.
  const isPractice = phase === Phase.PLAYING && sheet?.seats.length === 1 && !sheet.duration_s;
  return (
    <span class="phase" data-phase={phase}>
      {t(isPractice ? "phase.practice" : (`phase.${phase}` as "phase.0"))}
    </span>
  );
}

/** A sentence: what the phase means and what comes next. */
export function Hint({ match }: { match: Match }) {
  const text = useMemo(() => computed(() => hint(match)), [match]).value;
  return <span class="hint">{text}</span>;
}

export function isLast(frame: Frame, sheet: Sheet): boolean {
  const playing = frame.phase === Phase.PLAYING;
  return playing && sheet.duration_s > 0 && clockTicks(frame, sheet) <= LAST_TICKS;
}
