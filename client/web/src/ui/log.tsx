/** The events of a match, the newest first. */

import type { ComponentChildren } from "preact";
import type { Match } from "../core/match";
import { toldEvents } from "../core/rulings";
import type { Event } from "../core/wire";
import { said, t } from "../i18n";
import { eventClock } from "../i18n/words";

interface Props {
  match: Match;
  /** How many to show. */
  most?: number;
  /** Only these. */
  only?: (event: Event) => boolean;
  /** Shown after an event, such as a button. */
  extra?: (event: Event) => ComponentChildren;
  /** Another part of the page announces new events: a screen reader should hear them once. */
  toldElsewhere?: boolean;
}

export function EventLog({ match, most = 200, only, extra, toldElsewhere }: Props) {
  const told = toldEvents(match.events.value);
  const events = told.filter((event) => !only || only(event)).slice(-most);
  if (!events.length) return <p class="muted">{t("log.empty")}</p>;
  return (
    <ol class="log" aria-live={toldElsewhere ? "off" : "polite"}>
      {events.toReversed().map((event) => (
        <li key={event.number} data-kind={event.kind}>
          <time>{eventClock(event, match.sheet.value)}</time>
          <span>
            {said(event.said)}
            {extra?.(event)}
          </span>
        </li>
      ))}
    </ol>
  );
}
