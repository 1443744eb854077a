/** Says across the top what the page waits for; nothing while all is well. */

import type { Court } from "../core/court";
import { said, t } from "../i18n";

/** What the page waits for, in words; "" while all is well. */
export function waitsFor(court: Court): string {
  const { open, attempt, refused } = court.connection.state.value;
  if (refused) return said(refused);
  if (!open) return attempt > 1 ? t("link.page", { attempt }) : t("link.connecting");
  const link = court.link.value;
  if (link && !link.connected) {
    const seconds = Math.round(link.silent_s);
    const waits =
      seconds > 0 && court.begun.value
        ? t("link.court", { court: link.court, seconds })
        : t("link.noCourt", { court: link.court });
    return link.why ? `${waits} ${said(link.why)}` : waits;
  }
  return court.begun.value && !court.live.value ? t("link.stale") : "";
}

export function LinkBanner({ court }: { court: Court }) {
  if (court.outdated.value) {
    return (
      <div class="banner" role="alert">
        {t("link.outdated")}
        <button class="button" type="button" onClick={() => location.reload()}>
          {t("link.reload")}
        </button>
      </div>
    );
  }
  const text = waitsFor(court);
  return text ? (
    <div class="banner" role="status">
      {text}
    </div>
  ) : null;
}
