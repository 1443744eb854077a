/** The selected cells in one strip: − and +, a slider, and the tools for rows and legs. */

import { useSignal } from "@preact/signals";
import { setCell } from "../../../core/design/table";
import { t } from "../../../i18n";
import { placeName } from "../names";
import type { Sheet } from "./sheet";
import { Tools } from "./tools";
import { turnCells } from "./typist";
import "./strip.css";

const STEP_DEG = 5;
const USUAL = 90;

export function Strip({ sheet }: { sheet: Sheet }) {
  const table = sheet.table.value;
  const gesture = useSignal(0);
  const more = useSignal(false);
  if (!table) return null;
  const { row, col } = sheet.active.value;
  const found = table.rows[row];
  const cell = found?.cells[col];
  const [low, high] = table.ranges[col] ?? [-USUAL, USUAL];
  if (!found) return null;
  const place = placeName(table, row, col);
  const range = sheet.area.value;
  const count = (range.bottom - range.top + 1) * (range.right - range.left + 1);
  return (
    <div class="strip" role="toolbar" aria-label={t("design.tools")}>
      <span class="where" aria-hidden="true">
        {count > 1 ? t("design.cells", { count }) : place}
      </span>
      <button
        class="button round"
        type="button"
        aria-label={t("design.less", { degrees: STEP_DEG })}
        title={t("design.lessKey")}
        onClick={() => turnCells(sheet, -STEP_DEG)}
      >
        −
      </button>
      <input
        type="range"
        min={low}
        max={high}
        step={1}
        value={typeof cell === "number" ? cell : 0}
        disabled={typeof cell !== "number"}
        aria-label={place}
        aria-valuetext={`${cell}°`}
        onPointerDown={() => {
          gesture.value++;
        }}
        onInput={(event) => {
          const text = event.currentTarget.value;
          const name = `slide ${gesture.peek()} ${row} ${col}`;
          sheet.edit(t("design.step.turn"), (now) => setCell(now, row, col, text), name);
        }}
      />
      <button
        class="button round"
        type="button"
        aria-label={t("design.more", { degrees: STEP_DEG })}
        title={t("design.moreKey")}
        onClick={() => turnCells(sheet, STEP_DEG)}
      >
        +
      </button>
      <output class="angle">{typeof cell === "number" ? `${cell}°` : "–"}</output>
      <button
        class="button quiet small tools-button"
        type="button"
        aria-expanded={more.value}
        onClick={() => {
          more.value = !more.value;
        }}
      >
        {t("design.tools")}
      </button>
      {more.value && <Tools sheet={sheet} />}
    </div>
  );
}
