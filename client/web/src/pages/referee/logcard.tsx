/** The log of the match: filtered, numbered, and the place to take an event back. */

import { useSignal } from "@preact/signals";
import { canGo, goneEvents } from "../../core/rulings";
import type { Event } from "../../core/wire";
import { t } from "../../i18n";
import { EventLog } from "../../ui/log";
import { Act } from "./act";
import type { Desk } from "./desk";
import * as drafts from "./drafts";

const FILTERS = ["all", "decisions", "game", "trouble"] as const;
type Filter = (typeof FILTERS)[number];

const TROUBLE = new Set([
  "join",
  "leave",
  "silent",
  "heard",
  "fault",
  "rules",
  "strayed",
  "key-refused",
]);
const NOT_GAME = new Set([...TROUBLE, "decision", "ready"]);
const MOST = 1000;

export function LogCard({ desk }: { desk: Desk }) {
  const filter = useSignal<Filter>("all");
  const gone = goneEvents(desk.court.events.value);
  const why = desk.whyNot("take-back");
  return (
    <section class="card log-card" aria-labelledby="log-title">
      <header>
        <h2 id="log-title">{t("log.title")}</h2>
        <fieldset class="chips" aria-label={t("refLog.filter")}>
          {FILTERS.map((one) => (
            <label key={one} class="chip">
              <input
                type="radio"
                name="log-filter"
                checked={filter.value === one}
                onChange={() => {
                  filter.value = one;
                }}
              />
              {t(`refLog.${one}`)}
            </label>
          ))}
        </fieldset>
      </header>
      <EventLog
        match={desk.court}
        most={MOST}
        only={(event) => passes(event, filter.value)}
        extra={(event) => {
          const fate = gone.get(event.number);
          return (
            <span class="log-extra">
              <span class="muted number">#{event.number}</span>
              {fate && <span class="fate">{t(`refLog.${fate}`)}</span>}
              {!fate && canGo(event) && (
                <Act
                  why={why}
                  tone="small quiet"
                  label={`${t("decide.takeBack")}: ${t("refLog.event", { number: event.number })}`}
                  onAct={() => {
                    desk.draft.value = drafts.takeBack(event.number);
                  }}
                >
                  ↶ {t("decide.takeBack")}
                </Act>
              )}
            </span>
          );
        }}
      />
    </section>
  );
}

/** The newest event that still stands and can be taken back; null if there is none. */
export function newestToTakeBack(events: readonly Event[]): number | null {
  const gone = goneEvents(events);
  const found = events.findLast((event) => canGo(event) && !gone.has(event.number));
  return found?.number ?? null;
}

function passes(event: Event, filter: Filter): boolean {
  switch (filter) {
    case "decisions":
      return event.kind === "decision";
    case "game":
      return !NOT_GAME.has(event.kind);
    case "trouble":
      return TROUBLE.has(event.kind);
    default:
      return true;
  }
}
