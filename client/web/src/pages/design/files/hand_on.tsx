/** The way of the table to the page on which teams enter a contest. */

import { remembered } from "../../../core/settings";
import { t } from "../../../i18n";
import type { Court } from "./court";

/** Address of the contest's pages, as it was typed last. */
const address = remembered("contest-pages", "");

export function HandOn({ court }: { court: Court }) {
  return (
    <form
      class="row"
      onSubmit={(event) => {
        event.preventDefault();
        void court.handOn(address.peek());
      }}
    >
      <input
        aria-label={t("design.handOn.address")}
        placeholder="192.168.1.20:8080"
        value={address.value}
        maxLength={200}
        spellcheck={false}
        autocapitalize="off"
        onInput={(event) => {
          address.value = event.currentTarget.value;
        }}
      />
      <button class="button" type="submit" title={t("design.handOn.hint")}>
        {t("design.handOn")}
      </button>
    </form>
  );
}
