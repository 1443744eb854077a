/** The controls of what is played: play or pause, and the speed. */

import { useRef } from "preact/hooks";
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
  /** Whether the chooser was opened with a pointer: `:focus-visible` does not tell that. */
  const isPointed = useRef(false);
  return (
    <label class="speed">
      <span class="hidden-text">{t("replay.speed")}</span>
      <select
        title={t("replay.speed")}
        value={playback.speed.value}
        onPointerDown={() => {
          isPointed.current = true;
        }}
        onKeyDown={() => {
          isPointed.current = false;
        }}
        onChange={(event) => {
          playback.speed.value = Number(event.currentTarget.value);
          // Who chose with the mouse is done with it: the page's own keys count again.
          if (isPointed.current) event.currentTarget.blur();
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
