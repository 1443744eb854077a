/** The court's part of a contest: what comes next, who is late, and what a result changes. */

import { signal, useSignal } from "@preact/signals";
import { useEffect, useMemo } from "preact/hooks";
import { ownToken } from "../../core/address";
import { type CourtPlan, Desk as OfficeDesk } from "../../core/desk";
import { part } from "../../core/match";
import type { Phrase } from "../../core/phrase";
import { teamsOfNext } from "../../core/timetable";
import { BEATS_PER_S, Phase, SeatFlag } from "../../core/wire";
import { said, t } from "../../i18n";
import { team, timeOf, winnerOf } from "../../i18n/words";
import type { Desk } from "./desk";

const AGAIN_MS = 5000;
/** A team that has not come is shown as late after this time. */
const LATE_S = 60;

let office: OfficeDesk | null = null;
/** What the office said last; null: nothing. */
const plan = signal<CourtPlan | null>(null);

/** Who probably plays next at this court; "" if nobody knows. */
export function nextTeams(): string {
  return teamsOfNext(plan.value?.coming ?? []);
}

/**
 * The connection to the contest's office; null while there is none: the gateway has no office, the
 * court plays for itself, or the connection is not open.
 */
function officeOf(desk: Desk): OfficeDesk | null {
  const { welcome, sheet } = desk.court;
  if (!welcome.value?.desk || !sheet.value?.call || !desk.entered.value) return null;
  office ??= new OfficeDesk();
  return office.connection.state.value.open ? office : null;
}

function ask(from: OfficeDesk, court: string, result: Result | null): Promise<CourtPlan> {
  const secret = ownToken() ?? "";
  return from.ask<CourtPlan>({ do: "court_day", secret, court, ...result });
}

interface Result {
  scores: [number, number];
  outcome: "left" | "right" | "draw";
}

/** What is played next at this court, and which team has not come. */
export function DayCard({ desk }: { desk: Desk }) {
  const from = officeOf(desk);
  const court = desk.court.sheet.value?.court ?? "";
  useEffect(() => {
    if (!from) return;
    const look = () =>
      ask(from, court, null).then(
        (found) => {
          plan.value = found;
        },
        () => undefined, // the card keeps what it has; the office may come back
      );
    void look();
    const timer = setInterval(look, AGAIN_MS);
    return () => clearInterval(timer);
  }, [from, court]);
  const coming = plan.value?.coming ?? [];
  if (!from || !plan.value) return null;
  return (
    <section class="card day" aria-labelledby="day-title">
      <h2 id="day-title">{t("day.title")}</h2>
      <Late desk={desk} />
      {coming.length === 0 && <p class="muted">{t("day.nothing")}</p>}
      <ol>
        {coming.map((slot) => (
          <li key={slot.pairing}>
            <time>{timeOf(slot.at_ms)}</time>
            <span>
              <b>{slot.teams.join(" – ")}</b> <small class="muted">{said(slot.fixture)}</small>
              {slot.held && <small class="warning"> {said(slot.held)}</small>}
            </span>
          </li>
        ))}
      </ol>
    </section>
  );
}

/** The teams of this game that have not taken their seats, and for how long they are awaited. */
function Late({ desk }: { desk: Desk }) {
  const { court } = desk;
  const waitedS = useMemo(
    () =>
      part(
        court,
        ({ phase, beat, seats }) => {
          if (phase !== Phase.LOBBY) return "";
          const left = (index: number) =>
            court.events.peek().findLast(({ kind, seat }) => kind === "leave" && seat === index);
          return seats
            .map(({ flags }, index) => {
              if (flags & SeatFlag.JOINED) return 0;
              return Math.floor((beat - (left(index)?.beat ?? 0)) / BEATS_PER_S);
            })
            .join(" ");
        },
        "",
      ),
    [court],
  ).value;
  const sheet = court.sheet.value;
  if (!sheet || !waitedS) return null;
  const waits = waitedS.split(" ").map(Number);
  return waits.map((seconds, index) => {
    if (seconds < LATE_S) return null;
    const values = { teams: team(sheet, index), minutes: Math.floor(seconds / 60) };
    return (
      <p key={sheet.seats[index]!.id} class="warning">
        {t("day.late", values)}
      </p>
    );
  });
}

/** What the result would change in the contest, before it is made. */
export function Standings({ desk, winner }: { desk: Desk; winner: string | null }) {
  const from = officeOf(desk);
  const { frame, sheet } = desk.court;
  const scores = (frame.value?.seats.map((seat) => seat.score) ?? []).join(" ");
  const court = sheet.value?.court ?? "";
  // Not by the scores: a game may have another winner.
  const outcome = (winner ?? winnerOf(desk.court)) as Result["outcome"] | null;
  const lines = useSignal<readonly Phrase[] | null>(null);
  useEffect(() => {
    const [left, right] = scores.split(" ").map(Number);
    if (!from || left === undefined || right === undefined) return;
    if (!outcome) {
      lines.value = null;
      return;
    }
    ask(from, court, { scores: [left, right], outcome }).then(
      ({ changes }) => {
        lines.value = changes;
      },
      () => undefined,
    );
  }, [from, court, scores, outcome, lines]);
  if (!from || !lines.value?.length) return null;
  return (
    <div class="preview standings" aria-live="polite">
      <p>{t("day.changes")}</p>
      <ul>
        {lines.value.map(said).map((line) => (
          <li key={line}>{line}</li>
        ))}
      </ul>
    </div>
  );
}
