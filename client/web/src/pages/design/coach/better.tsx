/** A better gait: first one's own guess of how much better it is, then its changes. */

import { useSignal } from "@preact/signals";
import type { CoachReply } from "../../../core/wire";
import { t } from "../../../i18n";
import { placeName } from "../names";
import { unit } from "../trials/figures";
import { signed } from "./coach";
import type { FoundProps } from "./matters";

const GAINS = ["little", "half", "double"] as const;
type Gain = (typeof GAINS)[number];
/** From how many times the score on a gain is "half", and "double". */
const HALF = 1.25;
const DOUBLE = 1.75;

function gainOf({ score_before, score_after }: CoachReply): Gain {
  const times = score_before > 0 ? score_after / score_before : Number.POSITIVE_INFINITY;
  return times >= DOUBLE ? "double" : times >= HALF ? "half" : "little";
}

export function Better({ coach, sheet, table, found }: FoundProps) {
  const { reply, rows, size } = found;
  const guess = useSignal<Gain | null>(null);
  const gain = reply.score_after - reply.score_before;
  if (!reply.changes.length) return <p>{t("design.coach.nothing")}</p>;
  if (!coach.revealed.value) {
    return (
      <div class="guess">
        <p>{t("design.coach.guessGain", { size: t(`design.coach.${size ?? "cell"}`) })}</p>
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
  return (
    <div class="better">
      {guess.value && (
        <p class={`verdict ${guess.value === gainOf(reply) ? "right" : "wrong"}`}>
          {guess.value === gainOf(reply)
            ? t("design.verdict.right", { was: t(`design.coach.gain.${guess.value}`) })
            : t("design.verdict.wrong", {
                guess: t(`design.coach.gain.${guess.value}`),
                was: t(`design.coach.gain.${gainOf(reply)}`),
              })}
        </p>
      )}
      <p class="verdict">
        {t("design.coach.gained", {
          before: unit(reply.score_before, 0),
          after: unit(reply.score_after, 0),
          gain: signed(gain),
        })}
        {reply.cancelled && <small class="muted"> {t("design.coach.stopped")}</small>}
      </p>
      <button class="button strong" type="button" onClick={() => coach.apply(found)}>
        {t("design.coach.apply")}
      </button>
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
    </div>
  );
}

function degrees(angle: number): string {
  return `${unit(angle, Number.isInteger(angle) ? 0 : 1)}°`;
}
