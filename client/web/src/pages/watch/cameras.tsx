/** The cameras to choose from, as buttons and keys. */

import type { Signal } from "@preact/signals";
import type { Sheet } from "../../core/wire";
import { type MessageName, t } from "../../i18n";
import type { CameraName } from "../../scene/View";
import { Kbd } from "../../ui/kbd";
import type { KeyRow } from "../../ui/key_help";

const CHOICE: readonly CameraName[] = ["auto", "arena", "top", "left", "right", "map"];
const ALONE: readonly CameraName[] = ["auto", "arena", "top", "chase", "map"];

/** What keys 1 to 6 do: each chooses a camera. */
export function cameraKeys(
  camera: Signal<CameraName>,
  sheet: () => Sheet | null,
): Record<string, () => void> {
  const press = (index: number) => () => {
    const chosen = choiceOf(sheet())[index];
    if (chosen) camera.value = chosen;
  };
  return Object.fromEntries(CHOICE.map((_, index) => [`Digit${index + 1}`, press(index)]));
}

/** The same in words. */
export function cameraRows(sheet: Sheet | null): readonly KeyRow[] {
  const names = choiceOf(sheet).map((name) => t(`camera.${name}` as MessageName));
  return names.map((name, index) => [[String(index + 1)], t("camera.row", { name })]);
}

export function Cameras({ camera, sheet }: { camera: Signal<CameraName>; sheet: Sheet | null }) {
  return (
    <fieldset class="cameras">
      <legend class="hidden-text">{t("camera.label")}</legend>
      {choiceOf(sheet).map((name, index) => {
        const word = t(`camera.${name}` as MessageName);
        return (
          <button
            key={name}
            type="button"
            class="button"
            aria-label={word}
            aria-pressed={camera.value === name}
            title={t("camera.key", { name: word, key: index + 1 })}
            onClick={() => {
              camera.value = name;
            }}
          >
            <Kbd>{index + 1}</Kbd>
            {word}
          </button>
        );
      })}
    </fieldset>
  );
}

function choiceOf(sheet: Sheet | null): readonly CameraName[] {
  return sheet?.seats.length === 1 ? ALONE : CHOICE;
}
