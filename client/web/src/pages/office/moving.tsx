/** A match is moved without dragging: by keyboard, or on a phone. */

import { useSignal } from "@preact/signals";
import type { OfficeView } from "../../core/desk";
import { clockOf, momentOf } from "../../core/timetable";
import { said, t } from "../../i18n";
import { Dialog } from "../../ui/dialog";
import type { Organiser } from "./organiser";
import { versusOf } from "./timetable";

interface Props {
  organiser: Organiser;
  view: OfficeView;
  pairing: string;
}

export function MoveDialog({ organiser, view, pairing }: Props) {
  const slot = view.slots.find((one) => one.pairing === pairing);
  const court = useSignal(slot?.moved?.court ?? "");
  const before = useSignal(slot?.moved?.before ?? "");
  const clock = useSignal(clockOf(slot?.moved?.not_before_ms ?? 0));
  if (!slot) return null;
  const sheet = organiser.feed.sheet.value;
  const others = view.slots.filter((one) => !one.running && one.pairing !== pairing);
  return (
    <Dialog title={t("office.move.title")} onClose={() => organiser.close()}>
      <form
        class="asks"
        onSubmit={async (event) => {
          event.preventDefault();
          const done = await organiser.do({
            do: "move",
            pairing,
            court: court.value,
            before: before.value,
            not_before_ms: momentOf(clock.value, Date.now()),
          });
          if (done) organiser.close();
        }}
      >
        <p>
          <b>{versusOf(slot, sheet)}</b> <span class="muted">{said(slot.fixture)}</span>
        </p>
        <label class="field">
          <span>{t("office.move.court")}</span>
          <select
            value={court.value}
            onChange={(event) => {
              court.value = event.currentTarget.value;
            }}
          >
            <option value="">{t("office.move.anyCourt")}</option>
            {view.courts.map((one) => (
              <option key={one.court} value={one.court}>
                {one.court}
              </option>
            ))}
          </select>
        </label>
        <label class="field">
          <span>{t("office.move.before")}</span>
          <select
            value={before.value}
            onChange={(event) => {
              before.value = event.currentTarget.value;
            }}
          >
            <option value="">{t("office.move.usual")}</option>
            {others.map((one) => (
              <option key={one.pairing} value={one.pairing}>
                {said(one.fixture)}: {versusOf(one, sheet)}
              </option>
            ))}
          </select>
        </label>
        <label class="field">
          <span>{t("office.move.time")}</span>
          <input
            type="time"
            value={clock.value}
            onInput={(event) => {
              clock.value = event.currentTarget.value;
            }}
          />
        </label>
        <button class="button strong" type="submit">
          {t("office.move")}
        </button>
      </form>
    </Dialog>
  );
}
