/** A recorded match at a moment of one's choice: what a court is for the live pages. */

import { computed, type ReadonlySignal, signal } from "@preact/signals";
import { recoloured } from "./colours";
import type { Match } from "./match";
import type { MatchRecord, PackedFrames, Since } from "./record";
import type { Moment } from "./timeline";
import {
  type Event,
  type Frame,
  type HealthVerdict,
  Phase,
  readFrame,
  type Scene,
  type Sheet,
} from "./wire";

/** Before the countdown: the robots are seen standing. */
const LEAD_IN_BEATS = 150;
/** After the last event: the result can be read. */
const LEAD_OUT_BEATS = 250;
/** Decoded frames that are kept: each one drawn is asked for several times. */
const KEPT_FRAMES = 16;

export class Recording implements Match {
  readonly frame = signal<Frame | null>(null);
  readonly sheet: ReadonlySignal<Sheet | null>;
  readonly scene: ReadonlySignal<Scene | null>;
  /** Those that have happened. */
  readonly events: ReadonlySignal<readonly Event[]>;
  readonly verdict: ReadonlySignal<HealthVerdict | null>;
  /** The beat that is shown, with its fraction. */
  readonly beat = signal(0);
  /** Where play begins and ends: without the wait in the lobby, and without what came after. */
  readonly firstBeat: number;
  readonly lastBeat: number;
  /** Until when the last picture must stay, so that the result can be read; `lastBeat` or later. */
  readonly heldUntil: number;
  private readonly frames: FrameStore;

  constructor(readonly record: MatchRecord) {
    this.frames = new FrameStore(record.frames);
    this.firstBeat = firstBeatOf(record);
    this.heldUntil = Math.max(this.firstBeat + 1, heldUntilOf(record));
    this.lastBeat = Math.min(this.heldUntil, Math.max(this.firstBeat + 1, record.lastBeat));
    const whole = computed(() => Math.floor(this.beat.value));
    this.sheet = recoloured(computed(() => newest(record.sheets, whole.value)));
    this.scene = computed(() => newest(record.scenes, whole.value));
    const happened = computed(() => countUntil(record.events, whole.value));
    this.events = computed(() => record.events.slice(0, happened.value));
    this.verdict = signal(record.verdict);
    this.seek(this.firstBeat);
  }

  /** Go to a beat, kept within the recording. */
  seek(beat: number): void {
    this.beat.value = Math.min(this.lastBeat, Math.max(this.firstBeat, beat));
    const whole = Math.floor(this.beat.value);
    if (this.frame.value?.beat !== whole) this.frame.value = this.frameAt(whole);
  }

  sample(): Moment | null {
    const beat = this.beat.peek();
    const index = this.frames.at(beat);
    const before = this.frames.get(index);
    const after = this.frames.get(Math.min(index + 1, this.frames.count - 1));
    // A frame is left out where nothing moves: then it holds until the beat before the next one.
    const part = after.beat > before.beat ? Math.max(0, 1 - (after.beat - beat)) : 0;
    return { before, after, part: Math.min(1, part), beat };
  }

  private frameAt(beat: number): Frame {
    const found = this.frames.get(this.frames.at(beat));
    const passed = beat - found.beat;
    // Waiting changes nothing but the beat and the countdown, so these have no frames of their own.
    return { ...found, beat, countdown_beats: Math.max(0, found.countdown_beats - passed) };
  }
}

/** Decodes frames when they are asked for. */
class FrameStore {
  readonly count: number;
  private readonly kept = new Map<number, Frame>();

  constructor(private readonly packed: PackedFrames) {
    this.count = packed.beats.length;
  }

  /** Index of the newest frame at a beat; the first one before it. */
  at(beat: number): number {
    const { beats } = this.packed;
    let low = 0;
    let high = beats.length - 1;
    while (low < high) {
      const middle = (low + high + 1) >> 1;
      if (beats[middle]! <= beat) low = middle;
      else high = middle - 1;
    }
    return low;
  }

  get(index: number): Frame {
    const known = this.kept.get(index);
    if (known) return known;
    const { bytes, starts } = this.packed;
    const frame = readFrame(bytes.subarray(starts[index]!, starts[index + 1]!));
    if (this.kept.size >= KEPT_FRAMES) this.kept.delete(this.kept.keys().next().value!);
    this.kept.set(index, frame);
    return frame;
  }
}

/** The value at a beat; before the first value, that one, so that there is a picture. */
export function newest<T>(since: readonly Since<T>[], beat: number): T | null {
  return (since.findLast((one) => one.beat <= beat) ?? since[0])?.value ?? null;
}

/** How many had happened at a beat. */
export function countUntil(events: readonly { beat: number }[], beat: number): number {
  return events.findLastIndex((event) => event.beat <= beat) + 1;
}

function firstBeatOf({ frames, phases }: MatchRecord): number {
  const first = frames.beats[0] ?? 0;
  const countdown = phases.find(({ value }) => value === Phase.COUNTDOWN);
  return Math.max(first, (countdown?.beat ?? first) - LEAD_IN_BEATS);
}

function heldUntilOf({ events, lastBeat }: MatchRecord): number {
  const over = events.findLast(({ kind }) => kind === "phase" || kind === "decision");
  const ended = over?.data.after;
  const isOver = ended === "OFFICIAL" || ended === "VOID" || ended === "FINISHED";
  return isOver ? over!.beat + LEAD_OUT_BEATS : lastBeat;
}
