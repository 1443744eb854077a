/** What a trial showed, and below it the tabs. */

import type { Signal } from "@preact/signals";
import { t } from "../../i18n";
import { CoachPanel } from "./coach/panel";
import { PhasePanel } from "./learning/panel";
import { Robot } from "./robot/facts";
import { GroupPanel } from "./sharing/group_panel";
import type { Studio } from "./studio";
import { TrialList } from "./trials/list";
import { Result } from "./trials/result";
import "./side.css";

const TABS = ["trials", "phase", "coach", "robot", "group"] as const;
export type Tab = (typeof TABS)[number];

interface Props {
  studio: Studio;
  tab: Signal<Tab>;
  onShare: () => void;
}

export function Side({ studio, tab, onShare }: Props) {
  const { sheet, trials, showing, robot } = studio;
  const can = studio.can.value;
  const tabs = TABS.filter(
    (name) =>
      (can.learn || name !== "phase") &&
      (can.coach || name !== "coach") &&
      (studio.group.news.value || name !== "group"),
  );
  return (
    <aside class="side">
      <Result sheet={sheet} trials={trials} showing={showing} onShare={onShare} />
      <div class="tabs" role="tablist" aria-label={t("design.more.title")}>
        {tabs.map((name, index) => (
          <button
            key={name}
            id={`tab-${name}`}
            type="button"
            role="tab"
            aria-selected={tab.value === name}
            aria-controls={`panel-${name}`}
            tabIndex={tab.value === name ? 0 : -1}
            onClick={() => {
              tab.value = name;
            }}
            onKeyDown={(event) => {
              const by = { ArrowRight: 1, ArrowLeft: -1 }[event.key];
              if (!by) return;
              tab.value = tabs[(index + by + tabs.length) % tabs.length]!;
              document.getElementById(`tab-${tab.value}`)?.focus();
            }}
          >
            {t(`design.tab.${name}`)}
            {name === "trials" && trials.all.value.length > 0 && (
              <small> {trials.all.value.length}</small>
            )}
          </button>
        ))}
      </div>
      <div
        id={`panel-${tab.value}`}
        role="tabpanel"
        aria-labelledby={`tab-${tab.value}`}
        class="panel"
      >
        {tab.value === "trials" && (
          <TrialList trials={trials} showing={showing} version={sheet.version.value} />
        )}
        {tab.value === "phase" && (
          <PhasePanel
            learning={studio.learning}
            sheet={sheet}
            trials={trials}
            can={can}
            canTry={studio.present.value === true}
            court={studio.court}
            files={studio.files}
            onVariants={() => {
              tab.value = "coach";
              void studio.coach.others.askVariants();
            }}
          />
        )}
        {tab.value === "coach" && (
          <CoachPanel
            coach={studio.coach}
            sheet={sheet}
            can={can}
            word={studio.learning.phases.value?.word ?? ""}
            trials={trials}
          />
        )}
        {tab.value === "group" && <GroupPanel group={studio.group} />}
        {tab.value === "robot" && (
          <Robot robot={robot} numbers={studio.numbers} files={studio.files} can={can} />
        )}
      </div>
    </aside>
  );
}
