/**
 * A recording for `lacoc film`: the page shows exactly the moment that it is told, and then waits.
 *
 * Nothing here depends on the time of day or on this machine's speed: there is no animation, and
 * views draw when the shutter says so. `lacoc film` uses only `window.__film`.
 */

import { signal } from "@preact/signals";
import { flag } from "../core/address";
import { inBase64 } from "../core/base64";
import { followColours } from "../core/colours";
import { cuesBetween, type Heard, heardAt } from "../core/cues";
import { fetched, readBeside } from "../core/record_files";
import { Recording } from "../core/recording";
import { t } from "../i18n";
import { BEATS_PER_S } from "../i18n/words";
import { Shutter } from "../scene/View";
import { rendered, type TimedCue } from "../ui/tones";
import { Broadcast, type Style, scaleOfWindow } from "./watch/broadcast";
import { cameraOfAddress, qualityOfAddress } from "./watch/flags";

const MS_PER_BEAT = 1000 / BEATS_PER_S;

/** One picture of a film. */
interface Step {
  beat: number;
  /** A new shot begins. */
  cut: boolean;
}

/** What `lacoc film` does with the page. */
interface Film {
  /** The first and the last beat of the film, once the recording is open and can be drawn. */
  open(): Promise<[number, number]>;
  /** Go through some pictures in order; the last one is in the browser's next frame. */
  show(steps: Step[]): Promise<void>;
  /**
   * The sound of all pictures, at `rate` samples a second: base64 of 16 bits for each side in turn.
   */
  sound(steps: Step[], fps: number, rate: number): Promise<string>;
  /** How the page draws: "low" or "high", or "map" without WebGL. */
  quality(): string;
}

declare global {
  interface Window {
    __film?: Film;
  }
}

const recording = signal<Recording | null>(null);
const shutter = new Shutter(flag("smooth", true));
const style: Style = {
  camera: cameraOfAddress(),
  quality: qualityOfAddress() ?? "low",
  transparent: false,
  hud: flag("hud", true),
  split: flag("split", false),
  shutter,
};
/** Points that the organiser of the contest gave instead of the court's. */
const decided = new URLSearchParams(location.search).getAll("decided").join(" : ");
const scale = signal(scaleOfWindow());
document.documentElement.classList.add("broadcast", "film");

window.__film = {
  async open() {
    const names = new URLSearchParams(location.search).getAll("file");
    const files = [];
    for (const name of names) files.push(...(await fetched(name, () => undefined)));
    const opened = new Recording(await readBeside(files));
    followColours(opened);
    recording.value = opened;
    await document.fonts.ready;
    while (!shutter.count) await drawn();
    await shutter.prepare();
    return [opened.firstBeat, opened.heldUntil];
  },
  async show(steps) {
    for (const [index, { beat, cut }] of steps.entries()) {
      recording.value?.seek(beat);
      // The page's parts follow the recording in a microtask; the cameras need what they have made.
      await turn();
      if (cut) shutter.cut();
      shutter.expose(beat * MS_PER_BEAT, index === steps.length - 1);
    }
  },
  async sound(steps, fps, rate) {
    const cues: TimedCue[] = [];
    let heard: Heard | null = null;
    for (const [index, { beat, cut }] of steps.entries()) {
      recording.value?.seek(beat);
      const { frame, sheet, events } = recording.value!;
      if (!frame.value || !sheet.value) continue;
      const now: Heard = heardAt(frame.value, sheet.value, events.value, heard);
      const told = cuesBetween(cut ? null : heard, now, events.value);
      cues.push(...told.map((cue) => ({ ...cue, atS: index / fps })));
      heard = now;
    }
    const samples = await rendered(cues, steps.length / fps, rate);
    return await inBase64(new Uint8Array(samples.buffer));
  },
  quality: () => window.__lacoc?.view?.quality ?? "",
};

/** Resolves when the browser has drawn once. */
function drawn(): Promise<unknown> {
  return new Promise((resolve) => requestAnimationFrame(resolve));
}

const channel = new MessageChannel();
const turns: (() => void)[] = [];
channel.port1.onmessage = () => turns.shift()?.();

/** Resolves in the next turn of the event loop, after all microtasks; no timer delays it. */
function turn(): Promise<void> {
  return new Promise((resolve) => {
    turns.push(resolve);
    channel.port2.postMessage(null);
  });
}

export default function Film() {
  const match = recording.value;
  return (
    <main class="overlay" style={`--scale: ${scale.value}`}>
      {match && (
        <Broadcast
          match={match}
          style={style}
          scale={scale}
          next={decided && t("result.decided", { points: decided })}
          isLast
        />
      )}
      {match?.record.header.setup.origin && <p class="what-if">{t("replay.forkShort")}</p>}
    </main>
  );
}
