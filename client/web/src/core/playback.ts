/** Plays something that has beats, such as a recorded match or a trial: time and speed. */

import { type ReadonlySignal, signal } from "@preact/signals";
import { BEATS_PER_S } from "./wire";

/** A hidden tab gets no pictures: what passed meanwhile is not made up for. */
const MOST_PASSED_MS = 250;

/** What is played. */
export interface Played {
  /** The beat that is shown, with its fraction. */
  readonly beat: ReadonlySignal<number>;
  readonly firstBeat: number;
  readonly lastBeat: number;
  /** Go to a beat, kept between the first and the last one. */
  seek(beat: number): void;
}

export class Playback {
  readonly playing = signal(false);
  readonly speed = signal(1);
  private lastMs = 0;
  private handle = 0;

  constructor(private readonly played: Played) {}

  play(): void {
    const { firstBeat, lastBeat } = this.played;
    if (this.playing.peek() || lastBeat <= firstBeat) return;
    if (this.isAtEnd()) this.seek(firstBeat);
    this.playing.value = true;
    this.lastMs = performance.now();
    this.handle = requestAnimationFrame(this.go);
  }

  pause(): void {
    this.playing.value = false;
    cancelAnimationFrame(this.handle);
  }

  toggle(): void {
    if (this.playing.peek()) this.pause();
    else this.play();
  }

  seek(beat: number): void {
    this.played.seek(beat);
  }

  /** Go to the beat before or after, and stand there. */
  step(beats: number): void {
    this.pause();
    this.seek(Math.floor(this.played.beat.peek()) + beats);
  }

  private isAtEnd(): boolean {
    return this.played.beat.peek() >= this.played.lastBeat;
  }

  private readonly go = (nowMs: number): void => {
    const passedMs = Math.min(MOST_PASSED_MS, Math.max(0, nowMs - this.lastMs));
    this.lastMs = nowMs;
    const beats = (passedMs / 1000) * BEATS_PER_S * this.speed.peek();
    this.seek(this.played.beat.peek() + beats);
    if (this.isAtEnd()) this.pause();
    else this.handle = requestAnimationFrame(this.go);
  };
}
