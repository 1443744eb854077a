/** Settings that all pages have: language, picture and colours. */

import type { ComponentChildren } from "preact";
import { chosenPalette, PALETTE_NAMES, type PaletteName } from "../core/colours";
import { isLoud, quality } from "../core/settings";
import { chosen, LANGUAGES, type Language, t } from "../i18n";
import { Dialog } from "./dialog";

interface Props {
  onClose: () => void;
  /** A page's own settings. */
  children?: ComponentChildren;
}

export function Settings({ onClose, children }: Props) {
  return (
    <Dialog title={t("settings.title")} onClose={onClose}>
      <div style="display: grid; gap: 14px; min-width: 280px">
        <label class="field">
          <span>{t("settings.language")}</span>
          <select
            value={chosen.value}
            onChange={(event) => {
              chosen.value = event.currentTarget.value as Language | "";
            }}
          >
            <option value="">{t("settings.languageAuto")}</option>
            {Object.entries(LANGUAGES).map(([code, name]) => (
              <option key={code} value={code}>
                {name}
              </option>
            ))}
          </select>
        </label>
        <label class="field">
          <span>{t("settings.quality")}</span>
          <select
            value={quality.value}
            onChange={(event) => {
              quality.value = event.currentTarget.value as typeof quality.value;
            }}
          >
            <option value="auto">{t("settings.auto")}</option>
            <option value="low">{t("settings.low")}</option>
            <option value="high">{t("settings.high")}</option>
          </select>
        </label>
        <label class="field">
          <span>{t("settings.colours")}</span>
          <select
            value={chosenPalette.value}
            onChange={(event) => {
              chosenPalette.value = event.currentTarget.value as PaletteName;
            }}
          >
            {PALETTE_NAMES.map((name) => (
              <option key={name} value={name}>
                {t(`settings.colours.${name}`)}
              </option>
            ))}
          </select>
        </label>
        <label class="field">
          <span>{t("settings.sound")}</span>
          <select
            value={isLoud.value ? "on" : "off"}
            onChange={(event) => {
              isLoud.value = event.currentTarget.value === "on";
            }}
          >
            <option value="on">{t("settings.soundOn")}</option>
            <option value="off">{t("settings.soundOff")}</option>
          </select>
        </label>
        {children}
      </div>
    </Dialog>
  );
}
