/** What the coach found: first one's own guess of how much it helps, then mistakes and changes. */

import { useSignal } from "@preact/signals";
import { figure } from "../../../core/design/trial";
import type { CoachReply } from "../../../core/wire";
import { said, t } from "../../../i18n";
import { placeName } from "../names";
import type { Sheet } from "../table/sheet";
import { shownTitle, unit } from "../trials/figures";
import { type Goal, signed } from "./coach";
import type { FoundProps } from "./matters";

const GAINS = ["little", "half", "double"] as const;
type Gain = (typeof GAINS)[number];
/** From how many times the figure of the goal on a gain is "half", and "double". */
const HALF = 1.25;
const DOUBLE = 1.75;
/** Of less than this nothing can be a multiple. */
const LEAST = 5;

/** The figure that a goal is about: forward speed [mm/s], or turning to its side [deg/s]. */
function goalValue(goal: Goal, figures: Record<string, unknown>): number {
  const value = figure(figures, goal === "forward" ? "speed_mm_s" : "drift_deg_s") ?? 0;
  return goal === "right" ? -value : value;
}

function gainOf(before: number, after: number): Gain {
  const times = after / before;
  return times >= DOUBLE ? "double" : times >= HALF ? "half" : "little";
}

export function Better({ coach, sheet, found }: FoundProps) {
  const { reply, rows, size, goal } = found;
  const guess = useSignal<Gain | null>(null);
  const [before, after] = [goalValue(goal, reply.before), goalValue(goal, reply.after)];
  if (!reply.changes.length) return <p>{t("design.coach.nothing")}</p>;
  if (before >= LEAST && !coach.revealed.value) {
    const what = reply.repairs.length ? "repair" : (size ?? "cell");
    return (
      <div class="guess">
        <p>{t("design.coach.guessGain", { size: t(`design.coach.${what}`) })}</p>
        <div class="row">
          {GAINS.map((name) => (
            <button
              key={name}
              class="button"
              type="button"
              onClick={() => {
                guess.value = name;
                coach.revealed.value = true;
              }}
            >
              {t(`design.coach.gain.${name}`)}
            </button>
          ))}
        </div>
      </div>
    );
  }
  const gain = gainOf(before, after);
  return (
    <div class="better">
      {guess.value && (
        <p class={`verdict ${guess.value === gain ? "right" : "wrong"}`}>
          {guess.value === gain
            ? t("design.verdict.right", { was: t(`design.coach.gain.${gain}`) })
            : t("design.verdict.wrong", {
                guess: t(`design.coach.gain.${guess.value}`),
                was: t(`design.coach.gain.${gain}`),
              })}
        </p>
      )}
      <Repairs reply={reply} rows={rows} sheet={sheet} />
      <p class="verdict">
        {t(goal === "forward" ? "design.coach.gained" : "design.coach.gainedTurn", {
          before: unit(before, 1),
          after: unit(after, 1),
          gain: signed(after - before),
        })}
        {reply.cancelled && <small class="muted"> {t("design.coach.stopped")}</small>}
      </p>
      {reply.worse.length > 0 && (
        <p class="harm">
          {t("design.coach.worse", {
            figures: reply.worse.map((name) => t(shownTitle(name))).join(t("design.coach.and")),
          })}
        </p>
      )}
      <button class="button strong" type="button" onClick={() => coach.apply(found)}>
        {t("design.coach.apply")}
      </button>
      <Changes reply={reply} rows={rows} sheet={sheet} />
    </div>
  );
}

interface PartProps {
  reply: CoachReply;
  rows: readonly number[];
  sheet: Sheet;
}

/** The mistakes that were repaired, each with its reason and what came of it. */
function Repairs({ reply, rows, sheet }: PartProps) {
  if (!reply.repairs.length) return null;
  return (
    <ol class="repairs" aria-label={t("design.coach.repairs")}>
      {reply.repairs.map(({ said: why, cell, before, after }, index) => (
        <li key={index}>
          <button
            type="button"
            onClick={() => sheet.select({ row: rows[cell.posture] ?? 0, col: cell.joint })}
            onPointerEnter={() => sheet.point([cell.joint])}
            onPointerLeave={() => sheet.point([])}
          >
            <span>{said(why)}</span>
            <small>
              {unit(before, 0)} → <b>{unit(after, 0)}</b>
            </small>
          </button>
        </li>
      ))}
    </ol>
  );
}

function Changes({ reply, rows, sheet }: PartProps) {
  const table = sheet.table.value;
  if (!table) return null;
  return (
    <ul>
      {reply.changes.map(({ cell, from_deg, to_deg }) => {
        const row = rows[cell.posture] ?? 0;
        return (
          <li key={`${cell.posture} ${cell.joint}`}>
            <button
              type="button"
              onClick={() => sheet.select({ row, col: cell.joint })}
              onPointerEnter={() => sheet.point([cell.joint])}
              onPointerLeave={() => sheet.point([])}
            >
              <span>{placeName(table, row, cell.joint)}</span>
              <small>
                {degrees(from_deg)} → <b>{degrees(to_deg)}</b>
              </small>
            </button>
          </li>
        );
      })}
    </ul>
  );
}

function degrees(angle: number): string {
  return `${unit(angle, Number.isInteger(angle) ? 0 : 1)}°`;
}
