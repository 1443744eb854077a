/** The controls with which a spectator sees the last moments again. */

import type { Rewind } from "../../core/rewind";
import { t } from "../../i18n";
import { IconButton } from "../../ui/icons";
import type { KeyRow } from "../../ui/key_help";
import { PlayButton, SpeedChooser } from "../../ui/playback";
import "./again.css";

const STEP_S = 10;
const SPEEDS = [0.25, 0.5, 1] as const;

/** While it is live a button that goes back; else all that one needs there. */
export function Again({ rewind }: { rewind: Rewind }) {
  const back = (
    <IconButton
      name="back"
      label={t("again.back", { seconds: STEP_S })}
      title={t("again.backKey", { seconds: STEP_S })}
      onClick={() => rewind.skip(-STEP_S)}
    />
  );
  if (!rewind.isBack.value) return <div class="again">{back}</div>;
  return (
    <fieldset class="again is-back">
      <legend class="hidden-text">{t("again.title")}</legend>
      <b role="status">{t("again.behind", { seconds: Math.round(rewind.behindS.value) })}</b>
      {back}
      <PlayButton playback={rewind.playback} title={(word) => `${word} (K)`} />
      <SpeedChooser playback={rewind.playback} speeds={SPEEDS} />
      <button class="button strong" type="button" onClick={() => rewind.goLive()}>
        {t("again.live")}
      </button>
    </fieldset>
  );
}

export function againRows(): readonly KeyRow[] {
  return [
    [["←", "→"], t("again.keys", { seconds: STEP_S })],
    [["K"], t("again.pause")],
    [["L"], t("again.live")],
  ];
}

export function againKeys(rewind: Rewind) {
  return {
    ArrowLeft: () => rewind.skip(-STEP_S),
    ArrowRight: () => rewind.skip(STEP_S),
    KeyK: () => rewind.toggle(),
    KeyL: () => rewind.goLive(),
  };
}
