/** Shows the decisive moment of the last minutes again while a match has a pause. */

import { signal } from "@preact/signals";
import { decisive } from "./figures";
import type { Match } from "./match";
import { Rewind } from "./rewind";
import { BEATS_PER_S, type Event, Phase } from "./wire";

/** Pauses by phase, and how long each is before anything is shown again. */
const PAUSES: Readonly<Record<number, { name: string; waitMs: number }>> = {
  [Phase.HALTED]: { name: "halt", waitMs: 2500 }, // it may be short
  [Phase.FINISHED]: { name: "over", waitMs: 4000 }, // people read the result first
  [Phase.OFFICIAL]: { name: "over", waitMs: 4000 },
};
const LOOK_MS = 100;
const RUN_UP_BEATS = 3 * BEATS_PER_S;
const AFTER_BEATS = BEATS_PER_S;
const SPEED = 0.5;

/**
 * The moment to show again; null: there is none.
 *
 * @param events Of the match.
 * @param firstBeat The oldest beat that can be shown.
 * @param sinceBeat What happened before was shown already, or had its pause.
 */
export function momentAgain(
  events: readonly Event[],
  firstBeat: number,
  sinceBeat: number,
): Event | null {
  const recent = events.filter(({ beat }) => beat > sinceBeat && beat - RUN_UP_BEATS >= firstBeat);
  return decisive(recent, -1);
}

export class Replays {
  readonly rewind: Rewind;
  /** What is shown again now; null: the picture is live, or somebody looks back by hand. */
  readonly shown = signal<Event | null>(null);
  private pause = "";
  private sinceMs = 0;
  private sinceBeat = 0;
  private match = "";

  constructor(private readonly live: Match) {
    this.rewind = new Rewind(live);
    setInterval(() => this.look(performance.now()), LOOK_MS);
  }

  /** Begin what is to be shown now, and end what was shown. */
  look(nowMs: number): void {
    const frame = this.live.frame.peek();
    if (!frame) return;
    const match = `${this.live.sheet.peek()?.court}/${frame.match}`; // each court counts its own
    if (match !== this.match) {
      this.match = match;
      this.sinceBeat = 0;
    }
    const { name = "", waitMs = 0 } = PAUSES[frame.phase] ?? {};
    const pause = name && `${match}/${name}`;
    if (pause !== this.pause) {
      this.pause = pause;
      this.sinceMs = nowMs;
      if (!pause) this.end();
    }
    const moment = this.shown.peek();
    if (moment) {
      const isOver = this.rewind.beat.peek() >= moment.beat + AFTER_BEATS;
      if (isOver || !this.rewind.isBack.peek()) this.end();
    } else if (pause && nowMs - this.sinceMs >= waitMs && !this.rewind.isBack.peek()) this.begin();
  }

  private begin(): void {
    const { rewind } = this;
    const moment = momentAgain(this.live.events.peek(), rewind.firstBeat, this.sinceBeat);
    this.sinceBeat = rewind.lastBeat; // each pause has one
    if (!moment) return;
    rewind.from(moment.beat - RUN_UP_BEATS, SPEED);
    if (rewind.isBack.peek()) this.shown.value = moment;
  }

  private end(): void {
    if (!this.shown.peek()) return;
    this.shown.value = null;
    this.rewind.goLive();
  }
}
