/** The corner of /watch and /replay: panel, settings and full screen, by button and by key. */

import { type Signal, signal } from "@preact/signals";
import type { ComponentChildren } from "preact";
import { t } from "../../i18n";
import { IconButton } from "../../ui/icons";
import type { KeyRow } from "../../ui/key_help";
import { isNarrow, toggleFullscreen } from "../../ui/screen";
import { Settings } from "../../ui/settings";

const settings = signal(false);

interface CornerProps {
  /** Whether the panel beside the scene is shown. */
  panel: Signal<boolean>;
  /** Buttons before these. */
  children?: ComponentChildren;
}

export function Corner({ panel, children }: CornerProps) {
  const keys = cornerKeys(panel);
  return (
    <nav class="corner right" aria-label={t("watch.controls")}>
      {children}
      {!isNarrow.value && (
        <IconButton
          name="panel"
          label={t("watch.panel")}
          title={t("watch.panelKey")}
          expanded={panel.value}
          onClick={keys.KeyE}
        />
      )}
      <IconButton
        name="settings"
        label={t("settings.title")}
        title={t("watch.settingsKey")}
        onClick={keys.KeyS}
      />
      <IconButton name="full" label={t("watch.fullscreen")} onClick={keys.KeyF} />
    </nav>
  );
}

/** The dialog that the corner opens; there also where the corner is hidden. */
export function CornerSettings({ children }: { children?: ComponentChildren }) {
  if (!settings.value) return null;
  return (
    <Settings
      onClose={() => {
        settings.value = false;
      }}
    >
      {children}
    </Settings>
  );
}

/** What these keys do. */
export function cornerRows(): readonly KeyRow[] {
  return [
    [["E"], t("watch.panel")],
    [["M"], t("keys.mute")],
    [["S"], t("settings.title")],
    [["F"], t("keys.fullscreen")],
  ];
}

export function cornerKeys(panel: Signal<boolean>) {
  return {
    KeyE: () => {
      panel.value = !panel.value;
    },
    KeyF: toggleFullscreen,
    KeyS: () => {
      settings.value = true;
    },
  };
}
