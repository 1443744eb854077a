/** Mistakes in files as a list: where each is, what was found and what was expected. */

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
    <ul class="mistakes">
      {mistakes.map((one, index) => (
        <li key={index} {...pointed(one)}>
          <p>{placeOf(one)}</p>
          <p>
            <strong>{said(one.found)}</strong>{" "}
            <span class="muted">{t("mistake.expected", { expected: said(one.expected) })}</span>
          </p>
        </li>
      ))}
    </ul>
  );
}

/** The file, the sheet and cell of a workbook or the entry of a robot file, the row and so on. */
function placeOf({ file, field, row, column, joint, leg }: Mistake): string {
  const parts = [
    file,
    field,
    row != null && t("mistake.row", { row }),
    column != null && t("mistake.column", { column }),
    joint != null && t("mistake.joint", { joint: leg ? `${joint} (${leg})` : joint }),
  ];
  return parts.filter(Boolean).join(" · ");
}
