/** All events of a recording; where one is now is marked, and each of them leads to its moment. */

import { computed } from "@preact/signals";
import { useEffect, useMemo, useRef } from "preact/hooks";
import { said, t } from "../../i18n";
import { eventClock } from "../../i18n/words";
import type { Player } from "./player";

export function ReplayLog({ player }: { player: Player }) {
  const { recording } = player;
  const list = useRef<HTMLOListElement>(null);
  const happened = useMemo(() => computed(() => recording.events.value.length), [recording]).value;
  useEffect(() => {
    const now = list.current?.children[Math.max(0, happened - 1)] as HTMLElement | undefined;
    if (!now || !list.current) return;
    // Not scrollIntoView: on a phone that would move the whole page.
    list.current.scrollTop = now.offsetTop - list.current.clientHeight / 2;
  }, [happened]);
  const { events } = recording.record;
  if (!events.length) return <p class="muted">{t("log.empty")}</p>;
  return (
    <ol class="log replay-log" ref={list}>
      {events.map((event, index) => (
        <li
          key={event.number}
          data-kind={event.kind}
          {...(event.seat >= 0 && { "data-seat": event.seat })}
          class={index >= happened ? "later" : ""}
          aria-current={index === happened - 1 ? "step" : undefined}
        >
          <button type="button" onClick={() => player.show(event)}>
            <time>{eventClock(event, recording.sheet.value)}</time>
            <span>{said(event.said)}</span>
          </button>
        </li>
      ))}
    </ol>
  );
}
