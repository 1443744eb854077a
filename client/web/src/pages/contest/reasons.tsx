/** Who goes on into a stage, and why: places before, tie rules, a lot, the organiser's hand. */

import { type ContestSheet, isOver, type StageView } from "../../core/contest/sheet";
import { said, t } from "../../i18n";

interface Props {
  sheet: ContestSheet;
  view: StageView;
}

/** Nothing for a stage that follows none. */
export function Reasons({ sheet, view }: Props) {
  const { name, entries } = view.stage;
  const reasons = sheet.reasons[name] ?? [];
  const drawn = sheet.decided.find(({ stage }) => stage === name);
  if (!reasons.length) return null;
  return (
    <details class="reasons" open={!isOver(view)}>
      <summary>{t("contest.reasons")}</summary>
      {drawn && (
        <p>
          {said(drawn.what)}
          {drawn.reason && t("notice.reason", { reason: drawn.reason })}
        </p>
      )}
      <ol>
        {entries.map((team, at) => (
          <li key={team}>
            <b>{team}</b> <span class="muted">{said(reasons[at]!)}</span>
          </li>
        ))}
      </ol>
    </details>
  );
}
