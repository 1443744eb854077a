/** What is done to whole rows and legs. */

import { addKey, addRow, canAdd, canRemove, removeRow } from "../../../core/design/rows";
import { copyLeg, halvesOf, mirrorLeg, mirrorRows, otherHalf } from "../../../core/design/tools";
import { t } from "../../../i18n";
import type { Sheet } from "./sheet";

export function Tools({ sheet }: { sheet: Sheet }) {
  const table = sheet.table.value!;
  const { row, col } = sheet.active.value;
  const area = sheet.area.value;
  const legs = table.legs.length;
  const leg = col % legs;
  const partner = mirrorLeg(leg, legs);
  const rows = Array.from({ length: area.bottom - area.top + 1 }, (_, at) => area.top + at);
  const halves = halvesOf(sheet.sequence.value ?? []);
  const others = halves.map(({ to }) => table.rows[to]!.key).join(", ");
  const tool = (name: string, isOn: boolean, act: () => void, hint?: string) => (
    <button class="button small" type="button" disabled={!isOn} title={hint} onClick={act}>
      {name}
    </button>
  );
  return (
    <div class="tools">
      {tool(t("design.tool.mirror"), true, () =>
        sheet.edit(t("design.tool.mirror"), (now) => mirrorRows(now, rows), null, "tool"),
      )}
      {tool(
        t("design.tool.half"),
        halves.length > 0,
        () => sheet.edit(t("design.tool.half"), (now) => otherHalf(now, halves), null, "tool"),
        t("design.tool.halfHint", { keys: others || "–" }),
      )}
      <label class="check">
        <input
          type="checkbox"
          checked={sheet.mirrors.value}
          disabled={!halves.length}
          onChange={(event) => {
            sheet.mirrors.value = event.currentTarget.checked;
          }}
        />
        {t("design.tool.live")}
      </label>
      {tool(
        t("design.tool.leg", { from: table.legs[leg] ?? leg, to: table.legs[partner] ?? partner }),
        partner !== leg,
        () =>
          sheet.edit(
            t("design.tool.copy"),
            (now) => copyLeg(now, rows, leg, partner),
            null,
            "tool",
          ),
      )}
      {tool(t("design.tool.addRow"), canAdd(table, row), () =>
        sheet.edit(t("design.tool.addRow"), (now) => addRow(now, row), null, "tool"),
      )}
      {table.kind === "locomotion" &&
        tool(t("design.tool.addKey"), true, () =>
          sheet.edit(t("design.tool.addKey"), (now) => addKey(now, row), null, "tool"),
        )}
      {tool(t("design.tool.removeRow"), canRemove(table, row), () =>
        sheet.edit(t("design.tool.removeRow"), (now) => removeRow(now, row), null, "tool"),
      )}
    </div>
  );
}
