/** Asks before entries are closed and the first stage is drawn, because that can't be undone. */

import type { OfficeView } from "../../core/desk";
import { t } from "../../i18n";
import { Dialog } from "../../ui/dialog";
import type { Organiser } from "./organiser";

interface Props {
  organiser: Organiser;
  view: OfficeView;
}

export function CloseDialog({ organiser, view }: Props) {
  const teams = view.teams.filter(({ state }) => state === "in" || state === "late");
  const left = view.teams.filter(({ state }) => state === "waits" || state === "refused");
  return (
    <Dialog title={t("office.close")} onClose={() => organiser.close()}>
      <div class="asks">
        <p>{t("office.close.text", { count: teams.length })}</p>
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
          {t("office.close.go", { count: teams.length })}
        </button>
      </div>
    </Dialog>
  );
}
