/** The selected cells in one strip: − and +, a slider, and the tools for rows and legs. */

import { useSignal } from "@preact/signals";
import { addKey, addRow, canAdd, canRemove, removeRow } from "../../core/design/rows";
import { setCell } from "../../core/design/table";
import { copyLeg, halvesOf, mirrorLeg, mirrorRows, otherHalf } from "../../core/design/tools";
import { t } from "../../i18n";
import { turnCells } from "./grid";
import { rowName } from "./rows";
import { jointName, type Studio } from "./studio";

const STEP_DEG = 5;
const USUAL = 90;

export function Strip({ studio }: { studio: Studio }) {
  const table = studio.table.value;
  const gesture = useSignal(0);
  const more = useSignal(false);
  if (!table) return null;
  const { row, col } = studio.active.value;
  const found = table.rows[row];
  const cell = found?.cells[col];
  const [low, high] = table.ranges[col] ?? [-USUAL, USUAL];
  if (!found) return null;
  const key = rowName(found, table.kind === "locomotion");
  const place = t("design.place", { key, joint: jointName(table.legs, col) });
  const range = studio.area.value;
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
        onClick={() => turnCells(studio, -STEP_DEG)}
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
          studio.edit(t("design.step.turn"), (now) => setCell(now, row, col, text), name);
        }}
      />
      <button
        class="button round"
        type="button"
        aria-label={t("design.more", { degrees: STEP_DEG })}
        title={t("design.moreKey")}
        onClick={() => turnCells(studio, STEP_DEG)}
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
      {more.value && <Tools studio={studio} />}
    </div>
  );
}

/** What is done to whole rows and legs. */
function Tools({ studio }: { studio: Studio }) {
  const table = studio.table.value!;
  const { row, col } = studio.active.value;
  const area = studio.area.value;
  const legs = table.legs.length;
  const leg = col % legs;
  const partner = mirrorLeg(leg, legs);
  const rows = Array.from({ length: area.bottom - area.top + 1 }, (_, at) => area.top + at);
  const halves = halvesOf(studio.sequence.value ?? []);
  const others = halves.map(({ to }) => table.rows[to]!.key).join(", ");
  const tool = (name: string, isOn: boolean, act: () => void, hint?: string) => (
    <button class="button small" type="button" disabled={!isOn} title={hint} onClick={act}>
      {name}
    </button>
  );
  return (
    <div class="tools">
      {tool(t("design.tool.mirror"), true, () =>
        studio.edit(t("design.tool.mirror"), (now) => mirrorRows(now, rows), null, "tool"),
      )}
      {tool(
        t("design.tool.half"),
        halves.length > 0,
        () => studio.edit(t("design.tool.half"), (now) => otherHalf(now, halves), null, "tool"),
        t("design.tool.halfHint", { keys: others || "–" }),
      )}
      <label class="check">
        <input
          type="checkbox"
          checked={studio.mirrors.value}
          disabled={!halves.length}
          onChange={(event) => {
            studio.mirrors.value = event.currentTarget.checked;
          }}
        />
        {t("design.tool.live")}
      </label>
      {tool(
        t("design.tool.leg", { from: table.legs[leg] ?? leg, to: table.legs[partner] ?? partner }),
        partner !== leg,
        () =>
          studio.edit(
            t("design.tool.copy"),
            (now) => copyLeg(now, rows, leg, partner),
            null,
            "tool",
          ),
      )}
      {tool(t("design.tool.addRow"), canAdd(table, row), () =>
        studio.edit(t("design.tool.addRow"), (now) => addRow(now, row)),
      )}
      {table.kind === "locomotion" &&
        tool(t("design.tool.addKey"), true, () =>
          studio.edit(t("design.tool.addKey"), (now) => addKey(now, row)),
        )}
      {tool(t("design.tool.removeRow"), canRemove(table, row), () =>
        studio.edit(t("design.tool.removeRow"), (now) => removeRow(now, row)),
      )}
    </div>
  );
}
