/** The day as a whole: a line to all, a pause, all later, and publishing. */

import { type Signal, useSignal } from "@preact/signals";
import { useEffect } from "preact/hooks";
import { stateOf } from "../../core/contest/sheet";
import type { Effect, OfficeView } from "../../core/desk";
import { momentOf } from "../../core/timetable";
import { said, t } from "../../i18n";
import { noticeText } from "../../ui/banner";
import { Dialog } from "../../ui/dialog";
import { PauseLine } from "../contest/pause";
import { Effects, Reason } from "./dialogs";
import type { Organiser } from "./organiser";

const MINUTE_MS = 60_000;
const LATER_MIN = { usual: 15, most: 1440 };

interface Props {
  organiser: Organiser;
  view: OfficeView;
}

export function DayBar({ organiser, view }: Props) {
  const { day, shift, announced, undrawable } = view;
  const held = noticeText({ text: "", ...day }, Date.now());
  const sheet = organiser.feed.sheet.value;
  const goesOn = view.drawn && !(sheet && stateOf(sheet) === "over");
  const over = (is: "pause" | "later" | "line" | "staff") => () => {
    organiser.over.value = { is };
  };
  return (
    <section class="day" aria-labelledby="day-title">
      <div class="bar">
        <h2 id="day-title">{t("office.day")}</h2>
        {held && (
          <button
            class="button strong"
            type="button"
            onClick={() => void organiser.do({ do: "resume" })}
          >
            {t("office.day.resume")}
          </button>
        )}
        {!held && goesOn && (
          <button class="button" type="button" onClick={over("pause")}>
            {t("office.day.pause")}
          </button>
        )}
        {goesOn && (
          <button class="button" type="button" onClick={over("later")}>
            {t("office.day.later")}
          </button>
        )}
        {shift && (
          <button
            class="button"
            type="button"
            onClick={() => void organiser.do({ do: "unshift", shift: shift.shift })}
          >
            {t("office.day.later.back", { minutes: Math.round(shift.by_ms / MINUTE_MS) })}
          </button>
        )}
        <button class="button" type="button" onClick={over("line")}>
          {t("office.day.line")}
        </button>
        {undrawable && (
          <button
            class="button"
            type="button"
            onClick={() => {
              organiser.over.value = { is: "undraw" };
            }}
          >
            {t("office.day.undraw", { stage: said(undrawable.title) })}
          </button>
        )}
        {!view.me && (
          <button class="button" type="button" onClick={over("staff")}>
            {t("office.day.staff")}
          </button>
        )}
        <button class="button" type="button" onClick={() => void organiser.do({ do: "publish" })}>
          {t("office.day.publish")}
        </button>
        {view.published && <a href={view.published}>{t("office.day.published")}</a>}
      </div>
      {sheet && <PauseLine sheet={sheet} />}
      {held && !sheet && (
        <p class="warning" role="status">
          {held}
        </p>
      )}
      {announced && <p>{t("office.day.announced", { text: announced })}</p>}
      {view.folder && <p class="muted folder">{t("office.day.folder", { folder: view.folder })}</p>}
      {view.me && <p class="muted">{t("office.day.me", { name: view.me })}</p>}
    </section>
  );
}

/** Games are called no more: until somebody says so, or until a time. */
export function PauseDialog({ organiser }: { organiser: Organiser }) {
  const until = useSignal("");
  const reason = useSignal("");
  return (
    <Dialog title={t("office.day.pause")} onClose={() => organiser.close()}>
      <form
        class="asks"
        onSubmit={async (event) => {
          event.preventDefault();
          const until_ms = momentOf(until.value, Date.now());
          if (await organiser.do({ do: "pause", until_ms, reason: reason.value.trim() }))
            organiser.close();
        }}
      >
        <p>{t("office.day.pause.text")}</p>
        <label class="field">
          <span>{t("office.day.until")}</span>
          <input
            type="time"
            value={until.value}
            onInput={(event) => {
              until.value = event.currentTarget.value;
            }}
          />
        </label>
        <Reason reason={reason} optional />
        <button class="button strong" type="submit">
          {t("office.day.pause.go")}
        </button>
      </form>
    </Dialog>
  );
}

/** All that is to come is later. */
export function LaterDialog({ organiser }: { organiser: Organiser }) {
  const minutes = useSignal(LATER_MIN.usual);
  const reason = useSignal("");
  return (
    <Dialog title={t("office.day.later")} onClose={() => organiser.close()}>
      <form
        class="asks"
        onSubmit={async (event) => {
          event.preventDefault();
          const by_ms = minutes.value * MINUTE_MS;
          if (await organiser.do({ do: "shift", by_ms, reason: reason.value.trim() }))
            organiser.close();
        }}
      >
        <p>{t("office.day.later.text")}</p>
        <label class="field">
          <span>{t("office.day.minutes")}</span>
          <input
            type="number"
            inputMode="numeric"
            min={1}
            max={LATER_MIN.most}
            step={1}
            required
            value={minutes.value}
            onInput={(event) => {
              minutes.value = event.currentTarget.valueAsNumber || 0;
            }}
          />
        </label>
        <Reason reason={reason} optional />
        <button class="button strong" type="submit">
          {t("office.day.later.go", { minutes: minutes.value })}
        </button>
      </form>
    </Dialog>
  );
}

/** A line that all pages show. */
export function LineDialog({ organiser, view }: Props) {
  const text = useSignal(view.announced);
  const tell = async (line: string) => {
    if (await organiser.do({ do: "announce", text: line })) organiser.close();
  };
  return (
    <Dialog title={t("office.day.line")} onClose={() => organiser.close()}>
      <form
        class="asks"
        onSubmit={(event) => {
          event.preventDefault();
          void tell(text.value);
        }}
      >
        <label class="field">
          <span>{t("office.day.line.text")}</span>
          <input
            value={text.value}
            maxLength={200}
            required
            onInput={(event) => {
              text.value = event.currentTarget.value;
            }}
          />
        </label>
        <button class="button strong" type="submit">
          {t("office.day.line.go")}
        </button>
        {view.announced && (
          <button class="button quiet" type="button" onClick={() => void tell("")}>
            {t("office.day.line.remove")}
          </button>
        )}
      </form>
    </Dialog>
  );
}

/** The draw of the newest stage is taken back; the dialog shows what that changes. */
export function UndrawDialog({ organiser, view }: Props) {
  const stage = view.undrawable?.stage ?? "";
  const reason = useSignal("");
  const effect = useEffectOf(organiser, { do: "undraw", stage, reason: "?" });
  if (!view.undrawable) return null;
  const title = t("office.day.undraw", { stage: said(view.undrawable.title) });
  return (
    <Dialog title={title} onClose={() => organiser.close()}>
      <form
        class="asks"
        onSubmit={async (event) => {
          event.preventDefault();
          const wish = { do: "undraw", stage, reason: reason.value.trim(), really: true } as const;
          if (await organiser.act(wish)) organiser.close();
        }}
      >
        <p>{t("office.day.undraw.text")}</p>
        <Reason reason={reason} />
        <Effects effect={effect.value} />
        <button class="button danger" type="submit" disabled={!reason.value.trim()}>
          {t("office.day.undraw.go")}
        </button>
      </form>
    </Dialog>
  );
}

/** Another team takes the place of a team that has not played. */
export function SubstituteDialog({ organiser, view, team }: Props & { team: string }) {
  const others = view.teams.filter((one) => one.reserve && one.team !== team);
  const substitute = useSignal("");
  const reason = useSignal("");
  const effect = useSignal<Effect | null>(null);
  const chosen = substitute.value;
  useEffect(() => {
    let newest = true;
    effect.value = null;
    if (chosen) {
      const wish = { do: "substitute", team, substitute: chosen, reason: "?" } as const;
      void organiser.preview(wish).then((found) => {
        if (newest) effect.value = found;
      });
    }
    return () => {
      newest = false;
    };
  }, [organiser, team, chosen]);
  return (
    <Dialog title={t("office.substitute.title", { team })} onClose={() => organiser.close()}>
      <form
        class="asks"
        onSubmit={async (event) => {
          event.preventDefault();
          const wish = {
            do: "substitute",
            team,
            substitute: chosen,
            reason: reason.value.trim(),
            really: true,
          } as const;
          if (await organiser.act(wish)) organiser.close();
        }}
      >
        <p>{t("office.substitute.text", { team })}</p>
        {!others.length && <p class="warning">{t("office.substitute.none")}</p>}
        <label class="field">
          <span>{t("office.substitute.who")}</span>
          <select
            value={chosen}
            required
            onChange={(event) => {
              substitute.value = event.currentTarget.value;
            }}
          >
            <option value="" />
            {others.map((one) => (
              <option key={one.team} value={one.team}>
                {one.team}
              </option>
            ))}
          </select>
        </label>
        <Reason reason={reason} />
        <Effects effect={effect.value} />
        <button class="button danger" type="submit" disabled={!chosen || !reason.value.trim()}>
          {t("office.substitute.go")}
        </button>
      </form>
    </Dialog>
  );
}

/** What a decision that does not change while the dialog is open would change. */
function useEffectOf(
  organiser: Organiser,
  wish: Parameters<Organiser["preview"]>[0],
): Signal<Effect | null> {
  const effect = useSignal<Effect | null>(null);
  useEffect(() => {
    void organiser.preview(wish).then((found) => {
      effect.value = found;
    });
  }, [organiser]);
  return effect;
}
