/**
 * Who goes on into a stage, and why: places before, tie rules, pairs kept apart, a lot, the
 * organiser's hand.
 */

import { type ContestSheet, isOver, type StageView } from "../../core/contest/sheet";
import { said, t } from "../../i18n";

interface Props {
  sheet: ContestSheet;
  view: StageView;
}

/** Nothing for a stage whose teams have the order in which they entered. */
export function Reasons({ sheet, view }: Props) {
  const { name, entries } = view.stage;
  const reasons = sheet.reasons[name] ?? [];
  const drawn = sheet.decided.find(({ stage }) => stage === name);
  if (!reasons.length) return null;
  return (
    <details class="reasons" open={!isOver(view)}>
      <summary>{t(view.plan.after ? "contest.reasons" : "contest.reasons.first")}</summary>
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
