/** Mistakes of a student's file as a table. */

import type { Mistake } from "../core/wire";
import { said, t } from "../i18n";

export function Mistakes({ mistakes }: { mistakes: readonly Mistake[] }) {
  return (
    <table class="mistakes">
      <thead>
        <tr>
          <th>{t("common.file")}</th>
          <th>{t("common.row")}</th>
          <th>{t("common.column")}</th>
          <th>{t("common.joint")}</th>
          <th>{t("common.found")}</th>
          <th>{t("common.expected")}</th>
        </tr>
      </thead>
      <tbody>
        {mistakes.map((one, index) => (
          <tr key={index}>
            <td>
              {one.file}
              {/* The sheet and the cell of a workbook. */}
              {one.row != null && one.field && <small>{one.field}</small>}
            </td>
            <td>{one.row ?? one.field ?? ""}</td>
            <td>{one.column ?? ""}</td>
            <td>{one.joint == null ? "" : `${one.joint}${one.leg ? ` (${one.leg})` : ""}`}</td>
            <td>{said(one.found)}</td>
            <td>{said(one.expected)}</td>
          </tr>
        ))}
      </tbody>
    </table>
  );
}
