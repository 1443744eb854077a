/** The referee's page: the state of the match from afar, and every decision a click or two away. */

import { useSignal, useSignalEffect } from "@preact/signals";
import { useEffect, useMemo } from "preact/hooks";
import { followColours } from "../core/colours";
import { Court } from "../core/court";
import { part } from "../core/match";
import { USUAL_HZ } from "../core/wire";
import { t } from "../i18n";
import { played } from "../i18n/words";
import { LinkBanner } from "../ui/banner";
import { KeyHelp, type KeyRow, showKeys } from "../ui/key_help";
import { ScoreBug } from "../ui/score";
import { hasKeyboard } from "../ui/screen";
import { Settings } from "../ui/settings";
import { Toasts, toast } from "../ui/toasts";
import "./referee.css";
import { Reasons } from "./referee/act";
import { AskDialog } from "./referee/ask";
import { DayCard } from "./referee/day";
import { Desk } from "./referee/desk";
import * as drafts from "./referee/drafts";
import { ActingBar, EnterCard } from "./referee/enter";
import { FieldCard } from "./referee/field";
import { HealthCard } from "./referee/health";
import { LogCard, newestToTakeBack } from "./referee/logcard";
import { MatchCard, takeNext } from "./referee/matchcard";
import type { Picked } from "./referee/pick";
import { Seats } from "./referee/seats";

const court = new Court(USUAL_HZ);
const desk = new Desk(court);
followColours(court);

export default function Referee() {
  const settings = useSignal(false);
  const picked = useSignal<Picked | null>(null);
  useTitle();
  useShortcuts((seat) => {
    const card = document.querySelector(`.seat[data-seat="${seat}"]`)?.getBoundingClientRect();
    if (card) picked.value = { seat, leftPx: card.left, topPx: card.top - 60 };
  }, showKeys);
  return (
    <main class="referee" data-phase={desk.phase.value} data-live={court.live.value}>
      <LinkBanner court={court} />
      <TopBar
        onHelp={showKeys}
        onSettings={() => {
          settings.value = true;
        }}
      />
      <div class="columns">
        <div class="column first">
          <EnterCard desk={desk} />
          <ActingBar desk={desk} />
          <MatchCard desk={desk} />
          <DayCard desk={desk} />
        </div>
        <div class="column middle">
          <FieldCard desk={desk} picked={picked} />
          <Seats desk={desk} />
        </div>
        <div class="column last">
          <HealthCard desk={desk} />
          <LogCard desk={desk} />
        </div>
      </div>
      <AskDialog desk={desk} />
      <KeyHelp rows={keyRows} also="Ctrl+/" text={t("referee.shortcutsText")} />
      {settings.value && (
        <Settings
          onClose={() => {
            settings.value = false;
          }}
        />
      )}
      <Reasons />
    </main>
  );
}

function TopBar({ onHelp, onSettings }: { onHelp: () => void; onSettings: () => void }) {
  const match = useMemo(() => part(court, (frame) => frame.match, 0), []).value;
  const sheet = court.sheet.value;
  return (
    <header class="top">
      <div class="title">
        <h1>
          {t("referee.title")}
          <span class="muted">
            {court.welcome.value?.contest && `${court.welcome.value.contest} · `}
            {sheet && `${t("referee.court", { court: sheet.court })} · `}
            {match > 0 && t("referee.match", { match })}
            {sheet && ` · ${played(sheet)}`}
          </span>
        </h1>
        <Toasts inPlace />
      </div>
      <ScoreBug match={court} />
      <nav>
        {hasKeyboard.value && (
          <button class="button quiet" type="button" onClick={onHelp}>
            {t("keys.title")}
          </button>
        )}
        <button class="button quiet" type="button" onClick={onSettings}>
          {t("settings.title")}
        </button>
      </nav>
    </header>
  );
}

function keyRows(): readonly KeyRow[] {
  return [
    [["Ctrl+Enter"], t("referee.keyNext")],
    [["Ctrl+←", "Ctrl+→"], t("referee.keyRobot")],
    [["Ctrl+Z"], t("referee.keyTakeBack")],
  ];
}

/** The tab's title shows the state too. */
function useTitle(): void {
  useSignalEffect(() => {
    const phase = t(`phase.${desk.phase.value}` as "phase.0");
    document.title = `${phase} · ${t("referee.title")} · LACOC`;
  });
}

function useShortcuts(pickRobot: (seat: number) => void, help: () => void): void {
  useEffect(() => {
    const press = (event: KeyboardEvent) => {
      if (!(event.ctrlKey || event.metaKey) || event.altKey || event.repeat) return;
      // A dialog has its own keys, and a field its own undo.
      if (document.querySelector("dialog[open]")) return;
      const writing = (event.target as Element).matches?.("input:not([type=radio]), textarea");
      if (event.key === "Enter") takeNext(desk);
      else if (event.key === "/") help();
      else if (writing) return;
      else if (event.key === "ArrowLeft") pickRobot(0);
      else if (event.key === "ArrowRight") pickRobot(1);
      else if (event.key.toLowerCase() === "z" && !event.shiftKey) takeNewestBack();
      else return;
      event.preventDefault();
    };
    addEventListener("keydown", press);
    return () => removeEventListener("keydown", press);
  });
}

function takeNewestBack(): void {
  const event = newestToTakeBack(court.events.value);
  const why = desk.whyNot("take-back") || (event === null ? t("refLog.nothing") : "");
  if (why) toast(why, "no");
  else if (event !== null) desk.draft.value = drafts.takeBack(event);
}
