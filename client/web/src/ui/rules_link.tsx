/** The way to all rules of the games, as a text that the gateway has. */

import { language, t } from "../i18n";

export function RulesLink() {
  return (
    <a href={`rules/${language.value}`} target="_blank" rel="noreferrer">
      {t("keys.rules")}
    </a>
  );
}
