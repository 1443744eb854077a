/** How a match ended: by the rules first, then officially. */

import type { ComponentChildren } from "preact";
import { useMemo } from "preact/hooks";
import { decisive, type Figures, figures } from "../core/figures";
import { type Match, phaseOf, scoresOf } from "../core/match";
import type { Phrase } from "../core/phrase";
import { corrections, decisionOf, declaration, playedTicks } from "../core/rulings";
import { type Event, Phase, type Sheet } from "../core/wire";
import { type MessageName, said, t } from "../i18n";
import { byRules, eventClock, logClock, markerName, team, winnerOf } from "../i18n/words";
import { ReplayLink } from "./replay_link";
import { SeatMark } from "./score";
import { TeamName } from "./team_name";
import "./result.css";

const SHOWN = new Set<number>([Phase.FINISHED, Phase.OFFICIAL, Phase.VOID]);

interface Props {
  match: Match;
  /** Index of the reader's own seat; less than 0: the reader watches. */
  own?: number;
  /** Closes the card; without it there is no button for that. */
  onClose?: () => void;
  /** Whether the card leads to the recording, once there is one. */
  withReplay?: boolean;
  /** Whether no other match follows, because the court has closed. */
  isLast?: boolean;
  /** What comes after the official result, as the page knows it. */
  next?: ComponentChildren;
  /** Further buttons. */
  children?: ComponentChildren;
}

/** What comes next at a court without an office; in a contest only the office knows. */
function nextAt({ fixture, settings }: Sheet): string {
  if (fixture) return "";
  return t(isJudged(settings) ? "result.next" : "result.nextByItself");
}

/** Whether a referee starts and ends the matches. */
function isJudged(settings: Sheet["settings"]): boolean {
  return (settings.match as { start?: string } | undefined)?.start !== "ready";
}

/** Whether a match is over, so that its result is shown. */
export function useResult(match: Match): boolean {
  return SHOWN.has(useMemo(() => phaseOf(match), [match]).value);
}

/** Nothing until the match is over. */
export function ResultCard(props: Props) {
  const { match, own = -1, onClose, withReplay, isLast, next, children } = props;
  const phase = useMemo(() => phaseOf(match), [match]).value;
  const scores = useMemo(() => scoresOf(match), [match]).value;
  const sheet = match.sheet.value;
  const winner = winnerOf(match);
  const isVoid = phase === Phase.VOID;
  if (!SHOWN.has(phase) || !sheet || !scores || (!isVoid && winner === null)) return null;
  const winnerIndex = isVoid ? -1 : sheet.seats.findIndex((seat) => seat.id === winner);
  const points = scores.split(" ").map(Number);
  const rest = points.filter((_, index) => index !== winnerIndex);
  const ahead = (points[winnerIndex] ?? 0) - Math.max(0, ...rest); // less than 0: declared
  return (
    <section
      class="result"
      data-phase={phase}
      data-seat={winnerIndex}
      aria-label={t("result.title")}
      aria-live={own < 0 ? "polite" : undefined}
    >
      <Kicker match={match} />
      <h1>
        {isVoid
          ? t("hint.void")
          : own >= 0 && own === winnerIndex
            ? t("result.youWin")
            : title(sheet, winner)}
      </h1>
      {winnerIndex >= 0 && rest.length > 0 && ahead > 0 && (
        <p class="by">{t("result.by", { points: ahead })}</p>
      )}
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
                <TeamName name={team(sheet, index)} />
              </span>
              <span class="points">{score}</span>
            </div>
          ))}
        </div>
      )}
      <Explained match={match} />
      {!isVoid && <Compared match={match} winner={winnerIndex} withReplay={withReplay} />}
      {(next || !isLast) && (
        <div class="next">
          {phase === Phase.FINISHED ? t("hint.finished") : (next ?? nextAt(sheet))}
        </div>
      )}
      <p class="row">
        {withReplay && <ReplayLink match={match} />}
        {children}
        {onClose && (
          <button class="button quiet" type="button" onClick={onClose}>
            {t("result.close")}
          </button>
        )}
      </p>
    </section>
  );
}

interface ComparedProps {
  match: Match;
  /** Index of the winner's seat; less than 0: nobody has won. */
  winner: number;
  withReplay: boolean | undefined;
}

/** How each figure is written; "" where there is none. */
const FIGURES = {
  moves: ({ moves }: Figures) => moves || "",
  largest: ({ largest }: Figures) => largest || "",
  restarts: ({ restarts }: Figures) => restarts || "",
  walked: ({ walkedM }: Figures) => walkedM && `${walkedM.toFixed(2)} m`,
  keys: ({ keys }: Figures) => keys || "",
  often: ({ often }: Figures, sheet: Sheet) => often.map((one) => pressed(one, sheet)).join(" · "),
};
/** A key and how often it was pressed: with its level where there are two. */
function pressed([key, times]: readonly [string, number], { levels }: Sheet): string {
  return `${levels.length > 1 ? key : key.slice(1)} ×${times}`;
}

const FIGURE_NAMES = Object.keys(FIGURES) as (keyof typeof FIGURES)[];

/** What people compare: figures of both teams, and the decisive moment. */
function Compared({ match, winner, withReplay }: ComparedProps) {
  const sheet = match.sheet.value!;
  const events = match.events.value;
  const each = figures(events, sheet.seats.length, match.verdict.value);
  const [left, right] = each;
  const moment = decisive(events, winner);
  if (!left || !right) return null;
  return (
    <>
      <table class="compared">
        <tbody>
          {FIGURE_NAMES.map((one) => {
            const values = [left, right].map((figures) => FIGURES[one](figures, sheet) || 0);
            return values.some(Boolean) ? (
              <tr key={one}>
                <td>{values[0]}</td>
                <th scope="row">{t(`result.figure.${one}`)}</th>
                <td>{values[1]}</td>
              </tr>
            ) : null;
          })}
        </tbody>
      </table>
      {moment && (
        <p class="why">
          {t(winner < 0 ? "result.largest" : "result.decisive", {
            time: eventClock(moment, sheet),
            what: said(moment.said),
          })}{" "}
          {withReplay && <ReplayLink match={match} beat={moment.beat} />}
        </p>
      )}
    </>
  );
}

function title(sheet: Sheet, winner: string | null): string {
  if (winner === "draw") return t("hint.draw");
  const index = sheet.seats.findIndex((seat) => seat.id === winner);
  return t("hint.wins", { team: team(sheet, index) });
}

/** Who decided the result, the rules or the referee, and whether it is final. */
function Kicker({ match }: { match: Match }) {
  const phase = useMemo(() => phaseOf(match), [match]).value;
  const kicker =
    phase === Phase.VOID
      ? "result.void"
      : phase === Phase.OFFICIAL
        ? "result.official"
        : isDeclared(match)
          ? "result.declared"
          : "result.byRules";
  return <p class="kicker">{t(kicker)}</p>;
}

/** Why play ended, why this team has won, and what the referee corrected. */
function Explained({ match }: { match: Match }) {
  const sheet = match.sheet.value;
  const events = match.events.value;
  const phase = useMemo(() => phaseOf(match), [match]).value;
  // Time that is left rounds up, as on a scoreboard; time that was played does not.
  const time = logClock(playedTicks(events));
  const end = events.findLast(({ data }) => data.after === "FINISHED" || data.after === "VOID");
  const reason = end?.said.values?.why as Phrase | undefined;
  const abort = events.findLast(({ data }) => data.decision === "abort");
  const corrected = sheet ? corrections(events) : [];
  const ruling = declaration(events);
  return (
    <>
      <p class="why">
        {reason ? t("result.ended", { reason: said(reason), time }) : t("result.time", { time })}
      </p>
      {phase === Phase.VOID && abort && <p class="why ruling">{reasonOf(abort)}</p>}
      {phase !== Phase.VOID && ruling && isDeclared(match) && (
        <p class="why ruling">
          {t("result.ruling")}
          {reasonOf(ruling)}
        </p>
      )}
      {corrected.length > 0 && (
        <div class="why corrected">
          {t("result.corrected")}
          <ul>
            {corrected.map((event) => (
              <li key={event.number}>
                {correction(event, sheet!, events)}
                {reasonOf(event)}
              </li>
            ))}
          </ul>
        </div>
      )}
    </>
  );
}

/** True if the winner differs from the winner by the rules. */
function isDeclared(match: Match): boolean {
  return byRules(match.events.value) !== winnerOf(match);
}

/** The reason of a decision, to stand behind it; "" if it has none. */
function reasonOf({ data }: Event): string {
  const reason = said((data.reason ?? "") as Phrase | string).trim();
  return reason && t("result.because", { reason });
}

/** A correction of the score in a few words. */
function correction(event: Event, sheet: Sheet, events: readonly Event[]): string {
  const decision = decisionOf(event);
  const teamOf = (seat: string) =>
    team(
      sheet,
      sheet.seats.findIndex(({ id }) => id === seat),
    );
  switch (decision?.type) {
    case "adjust":
      return t("result.adjusted", {
        points: `${decision.points > 0 ? "+" : "−"}${Math.abs(decision.points)}`,
        team: teamOf(decision.seat),
      });
    case "set": {
      const state = teamOf(decision.state) || t(`result.state.${decision.state}` as MessageName);
      return t("result.set", { marker: markerName(decision.marker), state });
    }
    case "take-back": {
      const struck = events.find(({ number }) => number === decision.event);
      return t("result.struck", { what: struck ? said(struck.said) : `${decision.event}` });
    }
    default:
      return said(event.said);
  }
}
