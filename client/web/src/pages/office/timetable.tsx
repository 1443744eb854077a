/** The timetable, a column for each court. A match can be dragged, or moved with its button. */

import { type Signal, useSignal } from "@preact/signals";
import { type ContestSheet, isHeld, named } from "../../core/contest/sheet";
import type { OfficeView, Slot } from "../../core/desk";
import { type Column, canDecide, canMove, columns, dropped } from "../../core/timetable";
import { said, t } from "../../i18n";
import { timeOf } from "../../i18n/words";
import type { Organiser } from "./organiser";

/** Most matches of a court that are shown at first. */
const SHOWN = 10;

interface Props {
  organiser: Organiser;
  view: OfficeView;
}

export function Timetable({ organiser, view }: Props) {
  const dragged = useSignal<Slot | null>(null);
  const all = useSignal(false);
  const there = columns(view);
  const more = Math.max(0, ...there.map(({ slots }) => slots.length - SHOWN));
  return (
    <section class="timetable" aria-labelledby="timetable-title">
      <div class="bar">
        <h2 id="timetable-title">{t("office.timetable")}</h2>
        <p class="muted">{t("office.timetable.hint")}</p>
      </div>
      <div class="columns">
        {there.map((column) => (
          <CourtColumn
            key={column.court}
            organiser={organiser}
            column={all.value ? column : { ...column, slots: column.slots.slice(0, SHOWN) }}
            dragged={dragged}
          />
        ))}
      </div>
      {more > 0 && !all.value && (
        <button
          class="button"
          type="button"
          onClick={() => {
            all.value = true;
          }}
        >
          {t("office.timetable.all")}
        </button>
      )}
    </section>
  );
}

interface ColumnProps {
  organiser: Organiser;
  column: Column;
  /** The match that is dragged now. */
  dragged: Signal<Slot | null>;
}

function CourtColumn({ organiser, column, dragged }: ColumnProps) {
  const { court, here, slots } = column;
  const over = useSignal("");
  const drop = (event: DragEvent, on: Slot | null) => {
    event.preventDefault();
    event.stopPropagation();
    const slot = dragged.peek();
    dragged.value = null;
    over.value = "";
    const wish = slot && dropped(slot, court, on);
    if (wish) void organiser.do(wish);
  };
  const enter = (event: DragEvent, name: string) => {
    if (!dragged.peek()) return;
    event.preventDefault();
    event.stopPropagation();
    over.value = name;
  };
  return (
    <section
      class="column"
      aria-label={t("contest.court", { court })}
      data-over={over.value === "-" || undefined}
      onDragOver={(event) => enter(event, "-")}
      onDragLeave={() => {
        over.value = "";
      }}
      onDrop={(event) => drop(event, null)}
    >
      <h3>{t("contest.court", { court })}</h3>
      {!here && (
        <p class="warning" role="status">
          {t("office.courtAway", { court })}
        </p>
      )}
      {!slots.length && <p class="muted">{t("office.courtFree")}</p>}
      <ol>
        {slots.map((slot) => (
          <li
            key={slot.pairing}
            class="slot"
            data-state={slot.running ? "running" : "open"}
            data-over={over.value === slot.pairing || undefined}
            draggable={canMove(slot)}
            onDragStart={(event) => {
              event.dataTransfer?.setData("text/plain", slot.pairing);
              dragged.value = slot;
            }}
            onDragEnd={() => {
              dragged.value = null;
              over.value = "";
            }}
            onDragOver={(event) => enter(event, slot.pairing)}
            onDrop={(event) => drop(event, slot)}
          >
            <Card organiser={organiser} slot={slot} />
          </li>
        ))}
      </ol>
    </section>
  );
}

/** Who plays, as far as that is known, in the order of the match. */
export function versusOf({ pairing, teams, who }: Slot, sheet: ContestSheet | null): string {
  if (who) return who.map(said).join(" – ");
  return (sheet ? named(sheet, pairing, teams).teams : teams).join(" – ");
}

function Card({ organiser, slot }: { organiser: Organiser; slot: Slot }) {
  const view = organiser.view.value;
  const held = view !== null && isHeld(view, Date.now());
  const versus = versusOf(slot, organiser.feed.sheet.value);
  const over = (is: "move" | "rule") => () => {
    organiser.over.value = { is, pairing: slot.pairing };
  };
  return (
    <>
      <span class="time" title={held ? t("office.notBefore.text") : undefined}>
        {slot.running
          ? t(slot.begun ? "office.now" : "office.called")
          : slot.at_ms
            ? held
              ? t("office.notBefore", { time: timeOf(slot.at_ms) })
              : timeOf(slot.at_ms)
            : "–"}
      </span>
      <b class="versus">{versus}</b>
      <span class="muted">{said(slot.fixture)}</span>
      {slot.moved && <small class="moved">{t("office.moved")}</small>}
      {slot.absent.map((team) => (
        <small key={team} class="warning">
          {t("office.notCome", { team, time: timeOf(slot.at_ms) })}
        </small>
      ))}
      {slot.held && <small class="warning">{said(slot.held)}</small>}
      <span class="acts">
        {canDecide(slot) && (
          <button
            class="button quiet small"
            type="button"
            aria-label={t("office.decideOf", { versus })}
            onClick={over("rule")}
          >
            {t("office.decide")}
          </button>
        )}
        {canMove(slot) && (
          <button
            class="button quiet small"
            type="button"
            aria-label={t("office.moveOf", { versus })}
            onClick={over("move")}
          >
            {t("office.move")}
          </button>
        )}
      </span>
    </>
  );
}
