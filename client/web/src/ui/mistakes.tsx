/** Mistakes of a student's file as a table. */

import type { Mistake } from "../core/wire";
import { said, t } from "../i18n";

interface Props {
  mistakes: readonly Mistake[];
  /** Called with the mistake that is pointed at; null: with none any more. */
  onPoint?: (mistake: Mistake | null) => void;
}

export function Mistakes({ mistakes, onPoint }: Props) {
  const pointed = (one: Mistake) =>
    onPoint && {
      tabIndex: 0,
      onPointerEnter: () => onPoint(one),
      onPointerLeave: () => onPoint(null),
      onFocus: () => onPoint(one),
      onBlur: () => onPoint(null),
    };
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
          <tr key={index} {...pointed(one)}>
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
