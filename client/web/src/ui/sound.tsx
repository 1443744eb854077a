/** Lets a match be heard: short tones at its cues. Nothing is told by sound alone. */

import { effect } from "@preact/signals";
import { useEffect } from "preact/hooks";
import { flag } from "../core/address";
import { type Cue, type CueName, cuesBetween, type Heard, heardAt } from "../core/cues";
import type { Match } from "../core/match";
import { isLoud } from "../core/settings";
import { BEATS_PER_S } from "../core/wire";
import { isTyping } from "./shortcuts";

/** A tone of a cue: when it begins [s], how high [Hz], how long [s], how loud (0 to 1). */
type Tone = readonly [at_s: number, hz: number, lasts_s: number, loud: number];

/** The tones of each cue; those of a seat are shifted by `SEAT_SHIFT`. */
const TONES: Record<CueName, readonly Tone[]> = {
  count: [[0, 440, 0.12, 0.5]],
  start: [[0, 880, 0.35, 0.6]],
  score: [
    [0, 587, 0.09, 0.35],
    [0.07, 784, 0.14, 0.35],
  ],
  lead: [
    [0.12, 659, 0.1, 0.35],
    [0.22, 880, 0.1, 0.35],
    [0.32, 1047, 0.22, 0.35],
  ],
  last: [[0, 660, 0.08, 0.3]],
  halt: [
    [0, 392, 0.16, 0.4],
    [0.16, 294, 0.3, 0.4],
  ],
  end: [
    [0, 523, 0.9, 0.3],
    [0, 659, 0.9, 0.3],
    [0, 784, 0.9, 0.3],
  ],
};
/** The right seat sounds a fourth higher than the left one, and from its own side. */
const SEAT_SHIFT = [1, 4 / 3] as const;
const SEAT_PAN = [-0.6, 0.6] as const;
const MOST_LATER_S = 0.2;
const ATTACK_S = 0.008;
const SILENT = 0.0001;
/** How a phone shakes at a cue [ms]. */
const SHAKES: Partial<Record<CueName, number>> = { start: 80, score: 30, end: 200 };

let context: AudioContext | null = null;

interface Props {
  match: Match;
  /** Whether it is quiet unless the address says `sound=1`: a stream has a sound of its own. */
  isQuiet?: boolean;
  /** Index of the reader's own seat: only its cues shake a phone. */
  own?: number;
}

export function Sound({ match, isQuiet = false, own = -1 }: Props) {
  useEffect(() => {
    if (isQuiet && !flag("sound", false)) return;
    if (isQuiet) wake(); // a program for streams asks for no press
    let heard: Heard | null = null;
    return effect(() => {
      const [frame, sheet, events] = [match.frame.value, match.sheet.value, match.events.value];
      if (!frame || !sheet) return;
      const now = heardAt(frame, sheet, events);
      // Through a tie nobody has taken the lead.
      if (now.leader < 0 && heard?.match === now.match) now.leader = heard.leader;
      const cues = cuesBetween(heard, now, events);
      heard = now;
      if (!cues.length) return;
      // A picture is shown a little after its frame has come: so is a sound.
      const shown = match.sample(performance.now())?.beat ?? frame.beat;
      const later_s = Math.min(MOST_LATER_S, Math.max(0, frame.beat - shown) / BEATS_PER_S);
      for (const cue of cues) tell(cue, later_s, own);
    });
  }, [match, isQuiet, own]);
  useEffect(() => {
    const mute = (event: KeyboardEvent) => {
      if (event.code !== "KeyM" || isTyping(event) || event.ctrlKey || event.metaKey) return;
      isLoud.value = !isLoud.peek();
    };
    addEventListener("keydown", mute);
    return () => removeEventListener("keydown", mute);
  }, []);
  return null;
}

function tell({ name, seat }: Cue, later_s: number, own: number): void {
  if (!isLoud.peek()) return;
  const shake = SHAKES[name];
  if (own >= 0 && shake && (seat < 0 || seat === own)) navigator.vibrate?.(shake);
  // A browser lets no page sound before somebody has pressed something on it.
  if (context?.state !== "running") return;
  const begin_s = context.currentTime + later_s;
  for (const tone of TONES[name]) sound(context, begin_s, tone, seat);
}

function sound(
  audio: AudioContext,
  cue_s: number,
  [at_s, hz, lasts_s, loud]: Tone,
  seat: number,
): void {
  const begin_s = cue_s + at_s;
  const source = new OscillatorNode(audio, {
    type: "triangle",
    frequency: hz * (SEAT_SHIFT[seat as 0] ?? 1),
  });
  const volume = new GainNode(audio, { gain: SILENT });
  volume.gain.setValueAtTime(SILENT, begin_s);
  volume.gain.exponentialRampToValueAtTime(loud, begin_s + ATTACK_S);
  volume.gain.exponentialRampToValueAtTime(SILENT, begin_s + lasts_s);
  source.connect(volume);
  volume
    .connect(new StereoPannerNode(audio, { pan: SEAT_PAN[seat as 0] ?? 0 }))
    .connect(audio.destination);
  source.start(begin_s);
  source.stop(begin_s + lasts_s);
}

function wake(): void {
  context ??= new AudioContext();
  void context.resume();
}

addEventListener("pointerdown", wake);
addEventListener("keydown", wake);
