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
/** The chosen tab; where there is none of this name, the first one is shown. */
export type Tab = (typeof TABS)[number];

interface Props {
  studio: Studio;
  tab: Signal<Tab>;
  onShare: () => void;
}

export function Side({ studio, tab: chosen, onShare }: Props) {
  const { sheet, trials, showing, robot } = studio;
  const can = studio.can.value;
  const tabs = TABS.filter(
    (name) =>
      (can.learn || name !== "phase") &&
      (can.coach || name !== "coach") &&
      (studio.group.news.value || name !== "group"),
  );
  const tab = tabs.includes(chosen.value) ? chosen.value : tabs[0]!;
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
            aria-selected={tab === name}
            aria-controls={`panel-${name}`}
            tabIndex={tab === name ? 0 : -1}
            onClick={() => {
              chosen.value = name;
            }}
            onKeyDown={(event) => {
              const by = { ArrowRight: 1, ArrowLeft: -1 }[event.key];
              if (!by) return;
              const next = tabs[(index + by + tabs.length) % tabs.length]!;
              chosen.value = next;
              document.getElementById(`tab-${next}`)?.focus();
            }}
          >
            {t(`design.tab.${name}`)}
            {name === "trials" && trials.all.value.length > 0 && (
              <small> {trials.all.value.length}</small>
            )}
          </button>
        ))}
      </div>
      <div id={`panel-${tab}`} role="tabpanel" aria-labelledby={`tab-${tab}`} class="panel">
        {tab === "trials" && (
          <TrialList
            trials={trials}
            robot={robot.robot.value}
            showing={showing}
            version={sheet.version.value}
          />
        )}
        {tab === "phase" && (
          <PhasePanel
            learning={studio.learning}
            sheet={sheet}
            trials={trials}
            can={can}
            canTry={studio.present.value === true}
            court={studio.court}
            files={studio.files}
            onVariants={() => {
              chosen.value = "coach";
              void studio.coach.others.askVariants();
            }}
          />
        )}
        {tab === "coach" && (
          <CoachPanel
            coach={studio.coach}
            sheet={sheet}
            can={can}
            word={studio.learning.phases.value?.word ?? ""}
            trials={trials}
          />
        )}
        {tab === "group" && <GroupPanel group={studio.group} />}
        {tab === "robot" && (
          <Robot robot={robot} numbers={studio.numbers} files={studio.files} can={can} />
        )}
      </div>
    </aside>
  );
}
