/** The head of the office: the contest, how teams enter, what to print, and the next step. */

import { short } from "../../core/address";
import { stateOf } from "../../core/contest/sheet";
import type { OfficeView } from "../../core/desk";
import { said, t } from "../../i18n";
import { dayTime } from "../../i18n/words";
import { IconButton } from "../../ui/icons";
import { type Organiser, PAPERS, type Paper } from "./organiser";

interface Props {
  organiser: Organiser;
  view: OfficeView;
  onSettings: () => void;
}

export function Head({ organiser, view, onSettings }: Props) {
  const { event, code } = view;
  const sheet = organiser.feed.sheet.value;
  const isOver = sheet !== null && stateOf(sheet) === "over";
  const waiting = organiser.waiting.value.length;
  const here = view.teams.filter(({ state }) => state === "in" || state === "late").length;
  return (
    <header class="head">
      <div class="title">
        <h1>{event.name}</h1>
        <p class="muted">
          {t(isOver ? "office.isOver" : event.open ? "office.open" : "office.closed")} ·{" "}
          {t("contest.teamCount", { count: here })}
          {waiting > 0 && <> · {t("office.waitingCount", { count: waiting })}</>}
          {event.open && event.closes_ms > 0 && (
            <> · {t("office.closesAt", { time: dayTime(event.closes_ms) })}</>
          )}
        </p>
      </div>
      {!isOver && ( // a team that comes late enters there, too
        <dl class="entrance">
          <div>
            <dt>{t("office.enterAt")}</dt>
            <dd>
              <a href="enter">{`${short(organiser.pages.value)}/enter`}</a>
            </dd>
          </div>
          <div>
            <dt>{t("office.code")}</dt>
            <dd class="code">{code}</dd>
            <dd>
              <button
                class="button small quiet"
                type="button"
                onClick={() => {
                  organiser.over.value = { is: "code" };
                }}
              >
                {t("office.newCode")}
              </button>
            </dd>
          </div>
        </dl>
      )}
      <div class="tools">
        {event.open && (
          <button
            class="button strong"
            type="button"
            onClick={() => {
              organiser.over.value = { is: "close" };
            }}
          >
            {t(organiser.closesOnly.value ? "office.closeOnly" : "office.close")}
          </button>
        )}
        {view.to_draw && (
          <button
            class="button strong"
            type="button"
            onClick={() => {
              organiser.over.value = { is: "draw" };
            }}
          >
            {t("office.draw", { stage: said(view.to_draw.title) })}
          </button>
        )}
        <label class="printing">
          <span class="hidden-text">{t("office.print")}</span>
          <select
            value=""
            onChange={(change) => {
              const paper = change.currentTarget.value as Paper;
              organiser.over.value = { is: "paper", paper };
            }}
          >
            <option value="" disabled>
              {t("office.print")}
            </option>
            {PAPERS.map((paper) => (
              <option key={paper} value={paper}>
                {t(`office.paper.${paper}`)}
              </option>
            ))}
          </select>
        </label>
        <a class="button" href="contest">
          {t("contest.title")}
        </a>
        <IconButton name="settings" label={t("settings.title")} onClick={onSettings} />
      </div>
    </header>
  );
}
