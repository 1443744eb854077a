/** All students, whoever needs help first. A card glides to its new place, or waits. */

import { useSignal } from "@preact/signals";
import { useLayoutEffect, useRef } from "preact/hooks";
import { dealt } from "../../core/class";
import { t } from "../../i18n";
import { StudentCard } from "./card";
import { GroupCard } from "./group_card";
import type { Teacher } from "./teacher";

const GLIDE_MS = 450;
/** A pointer that rests on the cards for longer is forgotten: a raised hand must come first. */
const HOLD_MS = 10_000;
const LEGEND = [
  ["met", "✓"],
  ["now", "3"],
  ["open", ""],
  ["skipped", "–"],
] as const;

export function Cards({ teacher }: { teacher: Teacher }) {
  const list = useRef<HTMLOListElement>(null);
  const order = teacher.order.value;
  const hold = useHold(teacher);
  /** The card that Tab leads to; arrow keys lead on to the others. */
  const current = useSignal("");
  useGlide(list, order.map(({ name }) => name).join("\n") + JSON.stringify(teacher.groups.value));
  const isThere = order.some(({ name }) => name === current.value);
  const first = isThere ? current.value : order[0]?.name;
  if (!teacher.state.value) return <div />; // the banner says why
  return (
    <section class="all" aria-label={t("class.cards")}>
      {order.length ? (
        <ol
          ref={list}
          class="students"
          {...hold}
          onFocusIn={(event) => {
            hold.onFocusIn();
            current.value = nameOf(event.target);
          }}
          onKeyDown={(event) => {
            hold.onKeyDown();
            step(event);
          }}
        >
          {dealt(order, teacher.groups.value).map(({ group, cards }) =>
            group ? (
              <GroupCard
                key={`group ${group.name}`}
                teacher={teacher}
                group={group}
                cards={cards}
                stop={first}
              />
            ) : (
              <StudentCard
                key={cards[0]!.name}
                teacher={teacher}
                card={cards[0]!}
                isStop={cards[0]!.name === first}
              />
            ),
          )}
        </ol>
      ) : (
        <p class="nobody">{t("class.nobody")}</p>
      )}
      <Legend holds={teacher.holds.value} />
    </section>
  );
}

/** Go to another card with the arrow keys, also to the row above or below. */
function step(event: KeyboardEvent): void {
  const list = event.currentTarget as HTMLElement;
  const items = [...list.querySelectorAll<HTMLElement>("button.student")];
  const at = items.indexOf(event.target as HTMLElement);
  const cards = [...list.children] as HTMLElement[];
  const columns = cards.filter(({ offsetTop }) => offsetTop === cards[0]?.offsetTop).length;
  const steps: Record<string, number> = {
    ArrowRight: 1,
    ArrowLeft: -1,
    ArrowDown: columns,
    ArrowUp: -columns,
    Home: -at,
    End: items.length - 1 - at,
  };
  const by = steps[event.key];
  if (by === undefined || event.ctrlKey || event.altKey || event.metaKey) return;
  event.preventDefault();
  items[at + by]?.focus();
}

function nameOf(target: EventTarget | null): string {
  return (target as HTMLElement | null)?.dataset.student ?? "";
}

function Legend({ holds }: { holds: boolean }) {
  return (
    <p class="legend">
      {LEGEND.map(([state, mark]) => (
        <span key={state} class="dots">
          <i data-state={state === "now" ? "open" : state} data-now={state === "now"}>
            {mark}
          </i>
          {t(`class.legend.${state}`)}
        </span>
      ))}
      <span>
        <i class="coached">C</i> {t("class.legend.coached")}
      </span>
      <span>
        <b>{t("class.best")}</b> / {t("class.last")} mm/s
      </span>
      {holds && <span class="holds">{t("class.holds")}</span>}
    </p>
  );
}

/** Keep the cards where they are while somebody is about to click one. */
function useHold(teacher: Teacher) {
  const timer = useRef(0);
  const free = () => {
    clearTimeout(timer.current);
    teacher.holds.value = false;
  };
  const hold = () => {
    clearTimeout(timer.current);
    timer.current = window.setTimeout(free, HOLD_MS);
    teacher.holds.value = true;
  };
  const isInside = (event: FocusEvent) =>
    (event.currentTarget as Element).contains(event.relatedTarget as Node | null);
  return {
    onPointerEnter: hold,
    onPointerMove: hold,
    onPointerLeave: free,
    onFocusIn: hold,
    onKeyDown: hold,
    onFocusOut: (event: FocusEvent) => {
      if (!isInside(event)) free();
    },
  };
}

/**
 * Let the items of a list glide to their new places.
 *
 * @param order Says with another value that the items may have moved.
 */
function useGlide(list: { current: HTMLElement | null }, order: string): void {
  const places = useRef(new Map<HTMLElement, readonly [number, number]>());
  // Where an item is put elsewhere in the page, it loses the focus.
  const focused = list.current?.contains(document.activeElement) ? document.activeElement : null;
  useLayoutEffect(() => {
    if (focused instanceof HTMLElement && document.activeElement === document.body) {
      focused.focus({ preventScroll: true });
    }
  });
  useLayoutEffect(() => {
    const before = places.current;
    const items = [...(list.current?.children ?? [])] as HTMLElement[];
    const placeOf = ({ offsetLeft, offsetTop }: HTMLElement) => [offsetLeft, offsetTop] as const;
    places.current = new Map(items.map((item) => [item, placeOf(item)]));
    if (matchMedia("(prefers-reduced-motion: reduce)").matches) return;
    for (const [item, [left, top]] of places.current) {
      const [wasLeft, wasTop] = before.get(item) ?? [left, top];
      if (wasLeft === left && wasTop === top) continue;
      const shift = `translate(${wasLeft - left}px, ${wasTop - top}px)`;
      const glide = { duration: GLIDE_MS, easing: "ease-out" };
      item.animate([{ transform: shift }, { transform: "none" }], glide);
    }
  }, [order, list]);
}
