/** The class: what 30 students do, at a glance, and who needs help first. */

import { type Signal, useSignal, useSignalEffect } from "@preact/signals";
import { useMemo } from "preact/hooks";
import { t } from "../i18n";
import { Dropping, useDrop } from "../ui/drop";
import { isNarrow } from "../ui/screen";
import { Settings } from "../ui/settings";
import { Toasts } from "../ui/toasts";
import { Cards } from "./class/cards";
import { Certificates } from "./class/certificates";
import { Controls, FileTrouble, HandoutDialog } from "./class/controls";
import { Details } from "./class/details";
import { Head, Troubles } from "./class/head";
import { Screens } from "./class/screens";
import { Teacher } from "./class/teacher";
import { Tournament } from "./class/tournament";
import "./class/class.css";
import "./class/screens.css";

const TABS = ["rules", "play"] as const;
type Tab = (typeof TABS)[number];

declare global {
  interface Window {
    /** What tests look at. */
    __class?: Teacher;
  }
}

export default function Class() {
  const teacher = useMemo(() => new Teacher(), []);
  const panel = useSignal(!isNarrow.peek());
  const tab = useSignal<Tab>("rules");
  const settings = useSignal(false);
  const dragging = useSignal(false);
  window.__class = teacher;
  useDrop(dragging, ([file]) => {
    if (file) void teacher.takeIn(file);
  });
  // A hand is seen from another tab too.
  useSignalEffect(() => {
    const count = teacher.hands.value;
    document.title = `${t(count ? "class.titleHands" : "class.title", { count })} – LACOC`;
  });
  if (teacher.screen.value?.shows === "certificates") return <Certificates teacher={teacher} />;
  return (
    <main class="class">
      <div class="desk" inert={teacher.screen.value !== null}>
        <Troubles teacher={teacher} />
        <Head
          teacher={teacher}
          panel={panel.value}
          onPanel={() => {
            panel.value = !panel.value;
          }}
          onSettings={() => {
            settings.value = true;
          }}
        />
        <div class="body">
          <Cards teacher={teacher} />
          {panel.value && teacher.state.value && <Panel teacher={teacher} tab={tab} />}
        </div>
      </div>
      <Details teacher={teacher} />
      <HandoutDialog teacher={teacher} />
      <FileTrouble teacher={teacher} />
      <Screens teacher={teacher} />
      {settings.value && (
        <Settings
          onClose={() => {
            settings.value = false;
          }}
        />
      )}
      <Dropping dragging={dragging}>{t("class.drop")}</Dropping>
      <Toasts />
    </main>
  );
}

function Panel({ teacher, tab }: { teacher: Teacher; tab: Signal<Tab> }) {
  return (
    <aside id="class-panel" class="side" aria-label={t("class.tabs")}>
      <div class="tabs" role="tablist" aria-label={t("class.tabs")}>
        {TABS.map((name, index) => (
          <button
            key={name}
            id={`tab-${name}`}
            type="button"
            role="tab"
            aria-selected={tab.value === name}
            aria-controls="class-tab"
            tabIndex={tab.value === name ? 0 : -1}
            onClick={() => {
              tab.value = name;
            }}
            onKeyDown={(event) => {
              if (event.key !== "ArrowRight" && event.key !== "ArrowLeft") return;
              tab.value = TABS[1 - index]!;
              document.getElementById(`tab-${tab.value}`)?.focus();
            }}
          >
            {t(`class.tab.${name}`)}
          </button>
        ))}
      </div>
      <div id="class-tab" role="tabpanel" aria-labelledby={`tab-${tab.value}`} class="panel">
        {tab.value === "rules" ? <Controls teacher={teacher} /> : <Tournament teacher={teacher} />}
      </div>
    </aside>
  );
}
