/** Cues as tones: the same on pages and in films. */

import type { Cue, CueName } from "../core/cues";

/** A tone of a cue: when it begins [s], how high [Hz], how long [s], how loud (0 to 1). */
type Tone = readonly [atS: number, hz: number, lastsS: number, loud: number];

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
/** No cue sounds longer than this [s]. */
export const LONGEST_S = 1;
/** The right seat sounds a fourth higher than the left one, and from its own side. */
const SEAT_SHIFT = [1, 4 / 3] as const;
const SEAT_PAN = [-0.6, 0.6] as const;
const ATTACK_S = 0.008;
const SILENT = 0.0001;

/** A cue at a time of its own [s]. */
export interface TimedCue extends Cue {
  atS: number;
}

/** Let a cue be heard at a time of the sound's own clock [s]. */
export function schedule(audio: BaseAudioContext, { name, seat }: Cue, atS: number): void {
  for (const tone of TONES[name]) sound(audio, atS, tone, seat);
}

/**
 * Make the sound of some cues.
 *
 * @returns Samples of both sides in turn, each with 16 bits, little endian.
 */
export async function rendered(
  cues: readonly TimedCue[],
  lastsS: number,
  rate: number,
): Promise<Int16Array<ArrayBuffer>> {
  const audio = new OfflineAudioContext(2, Math.max(1, Math.round(lastsS * rate)), rate);
  for (const cue of cues) schedule(audio, cue, cue.atS);
  const sides = await audio.startRendering();
  const [left, right] = [sides.getChannelData(0), sides.getChannelData(1)];
  const samples = new Int16Array(2 * left.length);
  for (let index = 0; index < left.length; index++) {
    samples[2 * index] = sampleOf(left[index]!);
    samples[2 * index + 1] = sampleOf(right[index]!);
  }
  return samples;
}

function sampleOf(value: number): number {
  return Math.round(32767 * Math.max(-1, Math.min(1, value)));
}

function sound(
  audio: BaseAudioContext,
  cueS: number,
  [atS, hz, lastsS, loud]: Tone,
  seat: number,
): void {
  const beginS = cueS + atS;
  const source = new OscillatorNode(audio, {
    type: "triangle",
    frequency: hz * (SEAT_SHIFT[seat as 0] ?? 1),
  });
  const volume = new GainNode(audio, { gain: SILENT });
  volume.gain.setValueAtTime(SILENT, beginS);
  volume.gain.exponentialRampToValueAtTime(loud, beginS + ATTACK_S);
  volume.gain.exponentialRampToValueAtTime(SILENT, beginS + lastsS);
  source.connect(volume);
  volume
    .connect(new StereoPannerNode(audio, { pan: SEAT_PAN[seat as 0] ?? 0 }))
    .connect(audio.destination);
  source.start(beginS);
  source.stop(beginS + lastsS);
}
