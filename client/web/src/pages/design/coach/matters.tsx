/** Which numbers matter: first one's own guess, then all of them, as colours in the table. */

import { useSignal } from "@preact/signals";
import type { Table } from "../../../core/design/table";
import { t } from "../../../i18n";
import { placeName } from "../names";
import type { Sheet } from "../table/sheet";
import { type Coach, effectOf, type Found, isStrong, signed } from "./coach";

export interface FoundProps {
  coach: Coach;
  sheet: Sheet;
  table: Table;
  found: Found;
}

export function Matters({ coach, sheet, table, found: { reply, rows } }: FoundProps) {
  const guess = useSignal<{ row: number; col: number } | null>(null);
  const { row, col } = sheet.active.value;
  const inKey = rows.includes(row);
  const nameOf = (at: number, joint: number) => placeName(table, at, joint);
  if (!coach.revealed.value) {
    return (
      <div class="guess">
        <p>{t("design.coach.guess")}</p>
        <p class="guessed">
          {inKey ? nameOf(row, col) : <span class="muted">{t("design.coach.guessInKey")}</span>}
        </p>
        <button
          class="button strong"
          type="button"
          disabled={!inKey}
          onClick={() => {
            guess.value = { row, col };
            coach.revealed.value = true;
          }}
        >
          {t("design.coach.reveal")}
        </button>
      </div>
    );
  }
  const ranked = reply.matters.filter(isStrong);
  const at = guess.value;
  const rank = at
    ? reply.matters.findIndex(({ cell }) => rows[cell.posture] === at.row && cell.joint === at.col)
    : -1;
  return (
    <div class="matters">
      {at && (
        <p class="verdict">
          {rank === 0
            ? t("design.coach.first", { place: nameOf(at.row, at.col) })
            : t("design.coach.rank", {
                place: nameOf(at.row, at.col),
                rank: rank + 1,
                count: reply.matters.length,
              })}
        </p>
      )}
      <p class="legend">
        <span class="swatch" aria-hidden="true" /> {t("design.coach.legend")}
      </p>
      <ol>
        {ranked.slice(0, 5).map(({ cell, up, down }) => {
          const place = rows[cell.posture] ?? 0;
          return (
            <li key={`${cell.posture} ${cell.joint}`}>
              <button
                type="button"
                onClick={() => sheet.select({ row: place, col: cell.joint })}
                onPointerEnter={() => sheet.point([cell.joint])}
                onPointerLeave={() => sheet.point([])}
              >
                <span>{nameOf(place, cell.joint)}</span>
                <small data-effect={effectOf(up, reply.score_before)}>+10° {signed(up)}</small>
                <small data-effect={effectOf(down, reply.score_before)}>−10° {signed(down)}</small>
              </button>
            </li>
          );
        })}
      </ol>
    </div>
  );
}
