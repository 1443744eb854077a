/** Mistakes of a student's file as a list: where each is, what was found and what was expected. */

import type { Mistake } from "../core/wire";
import { said, t } from "../i18n";

export function Mistakes({ mistakes }: { mistakes: readonly Mistake[] }) {
  return (
    <ul class="mistakes">
      {mistakes.map((one, index) => (
        <li key={index}>
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
