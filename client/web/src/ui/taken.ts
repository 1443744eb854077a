/** Sounds for a program that reads them from outside, as `lacoc stream` does. */

import { inBase64 } from "../core/base64";
import type { Cue } from "../core/cues";
import { LONGEST_S, rendered } from "./tones";

interface TakenCue {
  cue: Cue;
  /** When it is to be heard, as the time of the day [ms]. */
  atMs: number;
}

declare global {
  interface Window {
    /**
     * Takes the sounds since the last call: when each begins, as the time of the day [ms], and its
     * samples of both sides in turn as base64, each with 16 bits, little endian.
     */
    __sounds?: (rate: number) => Promise<[atMs: number, samples: string][]>;
  }
}

let untaken: TakenCue[] = [];

/** Keep a cue until the program takes it. */
export function take(cue: Cue, atMs: number): void {
  untaken.push({ cue, atMs });
}

window.__sounds = (rate) => {
  const cues = untaken;
  untaken = [];
  return Promise.all(
    cues.map(async ({ cue, atMs }): Promise<[number, string]> => {
      const samples = await rendered([{ ...cue, atS: 0 }], LONGEST_S, rate);
      return [atMs, await inBase64(new Uint8Array(samples.buffer))];
    }),
  );
};
