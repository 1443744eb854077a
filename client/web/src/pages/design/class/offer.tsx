/** Offers the table that the teacher handed out. */

import type { HandedTable } from "../../../core/wire";
import { t } from "../../../i18n";
import { Banner } from "../../../ui/banner";
import type { Handed } from "./handed";

export function Offer({ handed, offered }: { handed: Handed; offered: HandedTable }) {
  return (
    <Banner calm>
      <span>{t("design.handed", { title: offered.title })}</span>
      <span class="offer">
        <button class="button strong" type="button" onClick={() => handed.take(offered)}>
          {t("design.handed.take")}
        </button>
        <button class="button" type="button" onClick={() => handed.putOff(offered)}>
          {t("design.handed.later")}
        </button>
      </span>
    </Banner>
  );
}
