/** The button that takes the table to a court. */

import { t } from "../../../i18n";
import type { Court } from "./court";

export function CourtButton({ court }: { court: Court }) {
  const leads = court.leads.value;
  if (!leads) return null;
  return (
    <>
      <button
        class="button to-court"
        type="button"
        aria-busy={court.isGoing.value}
        title={t(`design.court.${leads}.hint`)}
        onClick={() => void court.go()}
      >
        {t(court.isGoing.value ? "design.court.going" : `design.court.${leads}`)}
      </button>
      {court.blocked.value && (
        <p role="status">
          <a href={court.blocked.value} target="_blank" rel="noreferrer">
            {t("design.court.open")}
          </a>
        </p>
      )}
    </>
  );
}
