/** The controls of what is played: play or pause, and the speed. */

import type { Playback } from "../core/playback";
import { t } from "../i18n";
import { Icon } from "./icons";

interface PlayProps {
  playback: Playback;
  /** The tooltip; without it, what the button does. */
  title?: (word: string) => string;
  onClick?: () => void;
}

export function PlayButton({ playback, title = (word) => word, onClick }: PlayProps) {
  const isPlaying = playback.playing.value;
  const word = t(isPlaying ? "replay.pause" : "replay.play");
  return (
    <button
      class="button strong"
      type="button"
      aria-label={word}
      title={title(word)}
      onClick={() => {
        onClick?.();
        playback.toggle();
      }}
    >
      <Icon name={isPlaying ? "pause" : "play"} />
    </button>
  );
}

interface SpeedProps {
  playback: Playback;
  speeds: readonly number[];
}

export function SpeedChooser({ playback, speeds }: SpeedProps) {
  return (
    <label class="speed">
      <span class="hidden-text">{t("replay.speed")}</span>
      <select
        title={t("replay.speed")}
        value={playback.speed.value}
        onChange={(event) => {
          playback.speed.value = Number(event.currentTarget.value);
        }}
      >
        {speeds.map((speed) => (
          <option key={speed} value={speed}>
            {speed}×
          </option>
        ))}
      </select>
    </label>
  );
}
