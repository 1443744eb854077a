/** Lets a match be heard: short tones at its cues. Nothing is told by sound alone. */

import { effect } from "@preact/signals";
import { useEffect } from "preact/hooks";
import { flag } from "../core/address";
import { type Cue, type CueName, cuesBetween, type Heard, heardAt } from "../core/cues";
import { nameOfKey } from "../core/keys";
import type { Match } from "../core/match";
import { isLoud } from "../core/settings";
import { BEATS_PER_S } from "../core/wire";
import { isTyping } from "./shortcuts";
import { schedule } from "./tones";

/** How a phone shakes at a cue [ms]. */
const SHAKES: Partial<Record<CueName, number>> = { start: 80, score: 30, end: 200 };

/** Longest time that a picture comes after its frame [s]. */
const MOST_LATER_S = 0.2;

let context: AudioContext | null = null;
/** Where a program takes the sound, as `lacoc stream` does: then nothing is heard here. */
const taking = flag("taken", false) ? import("./taken") : null;

interface Props {
  match: Match;
  /** Whether it is quiet unless the address says `sound=1`: a stream has a sound of its own. */
  isQuiet?: boolean;
  /** Index of the reader's own seat: only its cues shake a phone. */
  own?: number;
}

export function Sound({ match, isQuiet = false, own = -1 }: Props) {
  useEffect(() => {
    if (isQuiet && !taking && !flag("sound", false)) return;
    if (isQuiet && !taking) wake(); // a program for streams asks for no press
    let heard: Heard | null = null;
    return effect(() => {
      const [frame, sheet, events] = [match.frame.value, match.sheet.value, match.events.value];
      if (!frame || !sheet) return;
      const now = heardAt(frame, sheet, events, heard);
      const cues = cuesBetween(heard, now, events);
      heard = now;
      if (!cues.length) return;
      // A picture is shown a little after its frame has come: so is a sound.
      const shown = match.sample(performance.now())?.beat ?? frame.beat;
      const laterS = Math.min(MOST_LATER_S, Math.max(0, frame.beat - shown) / BEATS_PER_S);
      for (const cue of cues) tell(cue, laterS, own);
    });
  }, [match, isQuiet, own]);
  useEffect(() => {
    const mute = (event: KeyboardEvent) => {
      if (event.ctrlKey || event.altKey || event.metaKey || event.repeat) return;
      if (nameOfKey(event) !== "KeyM" || isTyping(event)) return;
      isLoud.value = !isLoud.peek();
      wake();
    };
    addEventListener("keydown", mute);
    return () => removeEventListener("keydown", mute);
  }, []);
  return null;
}

function tell({ name, seat }: Cue, laterS: number, own: number): void {
  if (taking) {
    const atMs = performance.timeOrigin + performance.now() + 1000 * laterS;
    void taking.then(({ take }) => take({ name, seat }, atMs));
    return;
  }
  if (!isLoud.peek()) return;
  const shake = SHAKES[name];
  if (own >= 0 && shake && (seat < 0 || seat === own)) navigator.vibrate?.(shake);
  // A browser lets no page sound before somebody has pressed something on it.
  if (context?.state !== "running") return;
  schedule(context, { name, seat }, context.currentTime + laterS);
}

function wake(): void {
  if (!isLoud.peek()) return;
  context ??= new AudioContext();
  void context.resume();
}

addEventListener("pointerdown", wake);
addEventListener("keydown", wake);
