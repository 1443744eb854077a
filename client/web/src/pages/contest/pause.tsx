/** A pause or a break of the contest: until when, and what comes after it. */

import { type ContestSheet, isHeld } from "../../core/contest/sheet";
import { said, t } from "../../i18n";
import { endOf } from "../../i18n/words";
import { useIsBefore } from "../../ui/moment";
import { whoTitle } from "./words";

/** Nothing while games are called. */
export function PauseLine({ sheet }: { sheet: ContestSheet }) {
  const { day, pause } = sheet;
  const until_ms = pause?.until_ms ?? 0;
  const isOn = useIsBefore(until_ms) || (pause !== null && day.paused);
  if (!pause || !isOn) return null;
  const paused = isHeld(sheet, Date.now());
  const what = paused ? "contest.pause" : "contest.break";
  const time = endOf(until_ms);
  return (
    <p class="pause" role="status">
      <b>{until_ms ? t(`${what}.until`, { time }) : t("contest.pause.open")}</b>{" "}
      {day.reason && paused && `${t("notice.reason", { reason: day.reason })} `}
      {pause.fixture && pause.who && (
        <span>
          {t("contest.pause.then", { match: said(pause.fixture), who: whoTitle(pause.who) })}
        </span>
      )}
    </p>
  );
}
