/** Asks before entries are closed or a stage is drawn, because that can't be undone. */

import type { OfficeView } from "../../core/desk";
import { said, t } from "../../i18n";
import { Dialog } from "../../ui/dialog";
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

/** A stage that waits for the organiser: its teams, and the draw. */
export function DrawDialog({ organiser, view }: Props) {
  if (!view.to_draw) return null;
  const { stage, title, entries } = view.to_draw;
  return (
    <Dialog title={t("office.draw", { stage: said(title) })} onClose={() => organiser.close()}>
      <div class="asks">
        <p>{t("office.draw.text")}</p>
        <ol class="seeds">
          {entries.map((team) => (
            <li key={team}>{team}</li>
          ))}
        </ol>
        <a href="contest" target="_blank" rel="noreferrer">
          {t("office.draw.table")}
        </a>
        <button
          class="button strong"
          type="button"
          onClick={async () => {
            if (await organiser.do({ do: "draw", stage, entries })) organiser.close();
          }}
        >
          {t("office.draw.go", { count: entries.length })}
        </button>
      </div>
    </Dialog>
  );
}
