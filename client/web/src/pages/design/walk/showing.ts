/** What the picture shows: the posture of the active row, or a trial at a moment. */

import { batch, signal } from "@preact/signals";
import { Playback, type Played } from "../../../core/playback";
import type { Tried } from "../trials/tried";

export const SPEEDS = [0.1, 0.25, 0.5, 1, 2] as const;

export class Showing {
  /** The trial whose result is in sight. */
  readonly shown = signal<Tried | null>(null);
  /** The trial that the shown one is compared with. */
  readonly other = signal<Tried | null>(null);
  /** Whether the picture shows the trial; else it shows the posture of the active row. */
  readonly watching = signal(false);
  /** The moment of the trial, with its fraction. */
  readonly tick = signal(0);
  readonly playback: Playback;

  constructor() {
    const { tick } = this;
    const lastTick = () => Math.max(0, (this.shown.peek()?.trial.ticks ?? 0) - 1);
    const played: Played = {
      beat: tick,
      firstBeat: 0,
      get lastBeat() {
        return lastTick();
      },
      seek: (to) => {
        tick.value = Math.min(lastTick(), Math.max(0, to));
      },
    };
    this.playback = new Playback(played);
  }

  /** Show a trial from its beginning. */
  look(tried: Tried): void {
    batch(() => {
      this.shown.value = tried;
      this.watching.value = tried.trial.ticks > 0;
      if (this.other.peek() === tried) this.other.value = null;
      this.playback.seek(tried.trial.reply.starts[0] ?? 0);
    });
    this.playback.play();
  }

  /** Go to a tick of the shown trial. */
  seek(tick: number): void {
    this.watch();
    this.playback.seek(tick);
  }

  /** Go some ticks on or back, and stand there. */
  step(ticks: number): void {
    this.watch();
    this.playback.step(ticks);
  }

  /** Let the picture show the trial. */
  watch(): void {
    this.watching.value = this.shown.peek() !== null;
  }

  /** Let the picture show the posture of the active row. */
  rest(): void {
    this.watching.value = false;
    this.playback.pause();
  }

  /** Show no trial any more. */
  forget(): void {
    this.shown.value = this.other.value = null;
  }
}
