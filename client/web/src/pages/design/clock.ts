/** The moment of a trial that is shown, and its playback. */

import { signal } from "@preact/signals";
import { BEATS_PER_S } from "../../core/wire";

export const SPEEDS = [0.1, 0.25, 0.5, 1, 2] as const;

/** A hidden tab gets no pictures: what passed meanwhile is not made up for. */
const MOST_PASSED_MS = 250;

export class Clock {
  /** With its fraction. */
  readonly tick = signal(0);
  readonly playing = signal(false);
  readonly speed = signal<number>(1);
  /** The last tick. */
  readonly end = signal(0);
  private lastMs = 0;
  private handle = 0;

  play(): void {
    if (this.playing.peek() || !this.end.peek()) return;
    if (this.tick.peek() >= this.end.peek()) this.tick.value = 0;
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

  seek(tick: number): void {
    this.tick.value = Math.min(this.end.peek(), Math.max(0, tick));
  }

  /** Go to the tick before or after, and stand there. */
  step(ticks: number): void {
    this.pause();
    this.seek(Math.round(this.tick.peek()) + ticks);
  }

  private readonly go = (nowMs: number): void => {
    const passedMs = Math.min(MOST_PASSED_MS, Math.max(0, nowMs - this.lastMs));
    this.lastMs = nowMs;
    this.seek(this.tick.peek() + (passedMs / 1000) * BEATS_PER_S * this.speed.peek());
    if (this.tick.peek() >= this.end.peek()) this.pause();
    else this.handle = requestAnimationFrame(this.go);
  };
}
