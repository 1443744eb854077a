/** Asks before entries are closed or a stage is drawn, because that can't be undone. */

import { useSignal } from "@preact/signals";
import type { OfficeView, ToDraw } from "../../core/desk";
import { meetAgain } from "../../core/draw";
import { said, t } from "../../i18n";
import { Dialog } from "../../ui/dialog";
import { Reason } from "./dialogs";
import type { Organiser } from "./organiser";

interface Props {
  organiser: Organiser;
  view: OfficeView;
}

export function CloseDialog({ organiser, view }: Props) {
  const teams = view.teams.filter(({ state }) => state === "in" || state === "late");
  const left = view.teams.filter(({ state }) => state === "waits" || state === "refused");
  const what = organiser.closesOnly.value ? "office.closeOnly" : "office.close";
  return (
    <Dialog title={t(what)} onClose={() => organiser.close()}>
      <div class="asks">
        <p>{t(`${what}.text`, { count: teams.length })}</p>
        {left.length > 0 && (
          <p class="warning">
            {t("office.close.left", { teams: left.map(({ team }) => team).join(", ") })}
          </p>
        )}
        <button
          class="button strong"
          type="button"
          disabled={teams.length < 2}
          onClick={async () => {
            if (await organiser.do({ do: "close" })) organiser.close();
          }}
        >
          {t(`${what}.go`, { count: teams.length })}
        </button>
      </div>
    </Dialog>
  );
}

const HOW = ["", "lot", "hand"] as const;

/** A stage that waits for the organiser: its teams, in which order they come, and the draw. */
export function DrawDialog({ organiser, view }: Props) {
  const how = useSignal<(typeof HOW)[number]>("");
  const lot = useSignal("");
  const reason = useSignal("");
  const order = useSignal<readonly string[]>(view.to_draw?.entries ?? []);
  if (!view.to_draw) return null;
  const { stage, title, entries, why } = view.to_draw;
  const isFirst = !why.length; // no stage is before it
  const keepApart = () => {
    how.value = "hand";
    order.value = view.to_draw?.apart ?? entries;
    reason.value ||= t("office.draw.apart.reason");
  };
  const byHand = how.value === "hand";
  const whyOf = (team: string) => {
    const line = why[entries.indexOf(team)];
    return line && said(line);
  };
  const teams = byHand ? order.value : entries;
  const ready = how.value === "lot" ? lot.value.trim() : !byHand || reason.value.trim();
  return (
    <Dialog title={t("office.draw", { stage: said(title) })} onClose={() => organiser.close()}>
      <form
        class="asks"
        onSubmit={async (event) => {
          event.preventDefault();
          const wish = {
            stage,
            entries: [...teams],
            how: how.value,
            lot: how.value === "lot" ? lot.value.trim() : "",
            reason: byHand ? reason.value.trim() : "",
          };
          if (await organiser.do({ do: "draw", ...wish })) organiser.close();
        }}
      >
        <p>{t("office.draw.text")}</p>
        {!isFirst && <p>{t("office.draw.stays")}</p>}
        <fieldset>
          <legend>{t("office.draw.order")}</legend>
          {HOW.map((one) => (
            <label key={one} class="check">
              <input
                type="radio"
                name="how"
                checked={how.value === one}
                onChange={() => {
                  how.value = one;
                }}
              />
              {t(`office.draw.how.${one || (isFirst ? "listed" : "rank")}`)}
            </label>
          ))}
        </fieldset>
        {how.value === "lot" && (
          <label class="field">
            <span>{t("office.draw.lot")}</span>
            <input
              value={lot.value}
              maxLength={64}
              onInput={(event) => {
                lot.value = event.currentTarget.value;
              }}
            />
          </label>
        )}
        {how.value !== "lot" && (
          <ol class="seeds">
            {teams.map((team, at) => (
              <li key={team}>
                <b>{team}</b> <small class="muted">{whyOf(team)}</small>
                {byHand && at > 0 && (
                  <button
                    class="button quiet small"
                    type="button"
                    aria-label={t("office.draw.upOf", { team })}
                    onClick={() => {
                      order.value = raised(order.value, at);
                    }}
                  >
                    ↑
                  </button>
                )}
              </li>
            ))}
          </ol>
        )}
        <Again draw={view.to_draw} order={how.value === "lot" ? null : teams} onApart={keepApart} />
        {byHand && <Reason reason={reason} />}
        <a href="contest" target="_blank" rel="noreferrer">
          {t("office.draw.table")}
        </a>
        <button class="button strong" type="submit" disabled={!ready}>
          {t("office.draw.go", { count: entries.length })}
        </button>
      </form>
    </Dialog>
  );
}

interface AgainProps {
  draw: ToDraw;
  /** The teams in their order; null: a lot makes it. */
  order: readonly string[] | null;
  onApart: () => void;
}

/** Warns of matches that were played already, before the draw, and names the way out. */
function Again({ draw, order, onApart }: AgainProps) {
  const { apart, met } = draw;
  if (!order) return met.length ? <p class="warning">{t("office.draw.againLot")}</p> : null;
  const pairs = meetAgain(draw, order);
  if (!pairs.length) return null;
  const left = meetAgain(draw, apart.length ? apart : draw.entries).length;
  const better = apart.length > 0 && left < pairs.length;
  return (
    <div class="again" role="status">
      <p class="warning">
        {t("office.draw.again", {
          pairs: pairs.map((pair) => pair.join(" – ")).join(t("office.comma")),
        })}{" "}
        {!better && !apart.length && t("office.draw.againAll")}
      </p>
      {better && (
        <button class="button" type="button" onClick={onApart}>
          {t(left ? "office.draw.apartFewer" : "office.draw.apart")}
        </button>
      )}
    </div>
  );
}

/** The same teams with the one at a place one place higher. */
function raised(teams: readonly string[], at: number): string[] {
  return [...teams.slice(0, at - 1), teams[at]!, teams[at - 1]!, ...teams.slice(at + 1)];
}
