/** The newest event, across the lower part of the picture, in the colour of its team. */

import { computed } from "@preact/signals";
import { useMemo } from "preact/hooks";
import type { Match } from "../core/match";
import { type Event, type Frame, Phase, SeatFlag } from "../core/wire";
import { said, t } from "../i18n";
import { BEATS_PER_S, markerName, team } from "../i18n/words";
import { SeatMark } from "./score";
import "./thirds.css";

const SHOWN_BEATS = 4.5 * BEATS_PER_S;

/** The decisions that another part of the picture tells. */
const TOLD_ELSEWHERE = new Set(["start", "resume", "official", "next", "ready", "declare"]);
const KINDS_TOLD = new Set(["restart", "silent", "fault", "rules"]);

interface Props {
  match: Match;
  /** At most so many at once. */
  most?: number;
  /** Another part of the page tells a screen reader of events. */
  toldElsewhere?: boolean;
}

/**
 * The events of the last seconds. By beats, not by wall time: so it is right for a late comer,
 * with a delay, and at any place and speed of a recording.
 */
export function Thirds({ match, most = 3, toldElsewhere }: Props) {
  const shown = useMemo(
    () =>
      computed(() => {
        const frame = match.frame.value;
        const beat = frame?.beat ?? -1;
        const events = match.events.value;
        const from = events.findLastIndex((event) => event.beat <= beat - SHOWN_BEATS) + 1;
        const recent = events
          .slice(from)
          .filter((event) => event.beat <= beat && isTold(event) && isStillTrue(event, frame));
        return recent
          .slice(-most)
          .map(({ number }) => number)
          .join(" ");
      }),
    [match, most],
  );
  const numbers = shown.value ? shown.value.split(" ").map(Number) : [];
  const events = match.events.peek();
  return (
    <ol class="thirds" aria-live={toldElsewhere ? "off" : "polite"} aria-label={t("thirds.label")}>
      {numbers.map((number) => {
        const event = events.find((one) => one.number === number);
        return event && <Third key={number} match={match} event={event} />;
      })}
    </ol>
  );
}

function Third({ match, event }: { match: Match; event: Event }) {
  const sheet = match.sheet.value;
  const seat = sheet?.seats[event.seat];
  const points = pointsOf(event);
  if (!sheet) return null;
  return (
    <li
      class={`third${seat ? "" : " neutral"}`}
      data-kind={event.kind}
      {...(seat && { "data-seat": event.seat })}
    >
      {seat ? (
        <SeatMark sheet={sheet} index={event.seat} />
      ) : (
        <span class="seat-mark" aria-hidden="true">
          !
        </span>
      )}
      <span class="what">{sentence(match, event)}</span>
      {points !== 0 && <span class="gain">{points > 0 ? `+${points}` : points}</span>}
    </li>
  );
}

/** A short text for a game's event; without a short form, the court's own words. */
export function sentence(match: Match, event: Event): string {
  const sheet = match.sheet.peek();
  const { marker, also } = event.data as { marker?: string; also?: string[] };
  if (!sheet || !marker || event.seat < 0) return said(event.said);
  const name = team(sheet, event.seat);
  switch (event.kind) {
    case "flip": {
      const count = 1 + (also?.length ?? 0);
      const many = count > 1 ? "thirds.flips" : "thirds.flip";
      return t(many, { team: name, count, marker: markerName(marker) });
    }
    case "capture":
    case "strike":
      return t(`thirds.${event.kind}`, { team: name, marker: markerName(marker) });
    default:
      return said(event.said);
  }
}

/** False for a lost connection that is back, or that nobody needs any more: the game is over. */
function isStillTrue(event: Event, frame: Frame | null): boolean {
  if (event.kind !== "silent" || !frame) return true;
  const flags = frame.seats[event.seat]?.flags ?? 0;
  return frame.phase < Phase.FINISHED && (flags & SeatFlag.SILENT) !== 0;
}

/** Whether a third shows an event. */
export function isTold(event: Event): boolean {
  if (event.kind === "decision") return !TOLD_ELSEWHERE.has(String(event.data.decision));
  return isScoring(event) || KINDS_TOLD.has(event.kind);
}

/** Whether an event is a game's own: it changed the board. */
export function isScoring(event: Event): boolean {
  return event.seat >= 0 && "marker" in event.data;
}

function pointsOf(event: Event): number {
  const given = isScoring(event) ? event.data : (event.data.arguments as object | undefined);
  const points = (given as { points?: unknown } | undefined)?.points;
  return typeof points === "number" ? points : 0;
}
