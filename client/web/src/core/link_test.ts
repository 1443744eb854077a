/** A test of the link to the court, before a match: what is measured, and what it means. */

import { effect, signal } from "@preact/signals";
import type { Court } from "./court";
import { BEAT_S, BEATS_PER_S } from "./wire.gen.ts";

export const TEST_MS = 10_000;
const EVERY_MS = 100;
/** An answer that is later than this does not count as one any more. */
const PATIENCE_MS = 2000;
/** A frame is late if it comes so much later than the most punctual one of the last second. */
const LATE_MS = 100;

/** A link is judged by its slowest answers and by the frames that did not come in time. */
const LIMITS = [
  { verdict: "good", p95Ms: 100, missed: 0.01 },
  /** With the two waits of a page, this is within what a court usually makes equal (400 ms). */
  { verdict: "equal", p95Ms: 300, missed: 0.05 },
] as const;

export type LinkVerdict = "good" | "equal" | "slow";

/** A frame as it arrived. */
export interface Arrival {
  match: number;
  beat: number;
  atMs: number;
}

/** What a test found. */
export interface LinkFound {
  /** From the page to the court and back; null: there was no answer. */
  p50Ms: number | null;
  p95Ms: number | null;
  /** Frames that the court sent meanwhile; 0: no court sends any. */
  frames: number;
  lost: number;
  late: number;
  verdict: LinkVerdict;
}

/**
 * Judge a link. Pure.
 *
 * @param tripsMs Of all questions; Infinity: there was no answer.
 * @param arrivals Of the frames, in their order.
 */
export function judge(tripsMs: readonly number[], arrivals: readonly Arrival[]): LinkFound {
  const sorted = [...tripsMs].sort((one, other) => one - other);
  const part = (share: number) => sorted[Math.ceil(share * sorted.length) - 1] ?? Infinity;
  const [p50, p95] = [part(0.5), part(0.95)];
  const { frames, lost, late } = count(arrivals);
  const missed = frames ? (lost + late) / frames : 0;
  const met = LIMITS.find((limit) => p95 <= limit.p95Ms && missed <= limit.missed);
  const known = (ms: number) => (Number.isFinite(ms) ? ms : null);
  return {
    p50Ms: known(p50),
    p95Ms: known(p95),
    frames,
    lost,
    late,
    verdict: met?.verdict ?? "slow",
  };
}

function count(arrivals: readonly Arrival[]): Pick<LinkFound, "frames" | "lost" | "late"> {
  let [frames, lost, late] = [0, 0, 0];
  arrivals.forEach((arrival, index) => {
    const recent = arrivals
      .slice(Math.max(0, index - BEATS_PER_S), index)
      .filter(({ match }) => match === arrival.match);
    const skipped = recent.length ? arrival.beat - recent[recent.length - 1]!.beat - 1 : 0;
    lost += skipped;
    frames += 1 + skipped;
    if (offsetMs(arrival) - Math.min(...recent.map(offsetMs)) > LATE_MS) late++;
  });
  return { frames, lost, late };
}

/** When the match would have begun, if frames took no time. */
function offsetMs({ beat, atMs }: Arrival): number {
  return atMs - 1000 * BEAT_S * beat;
}

/** One test; it begins at once. */
export class LinkTest {
  /** How much of it is done, from 0 to 1. */
  readonly done = signal(0);
  /** null while it runs. */
  readonly found = signal<LinkFound | null>(null);
  private readonly arrivals: Arrival[] = [];
  private readonly tripsMs: number[] = [];
  private readonly beganMs = performance.now();
  private readonly timer: ReturnType<typeof setInterval>;
  private readonly unfollow: () => void;

  constructor(private readonly court: Court) {
    this.unfollow = effect(() => {
      const frame = court.frame.value;
      const atMs = performance.now();
      if (!frame) return;
      const last = this.arrivals[this.arrivals.length - 1];
      // A court that stands still sends its last frame again.
      if (last?.match === frame.match && last.beat >= frame.beat) return;
      this.arrivals.push({ match: frame.match, beat: frame.beat, atMs });
    });
    this.arrivals.length = 0; // the frame of before may be old
    this.timer = setInterval(() => this.look(), EVERY_MS);
  }

  /** Stop it. */
  end(): void {
    clearInterval(this.timer);
    this.unfollow();
  }

  private look(): void {
    const passedMs = performance.now() - this.beganMs;
    this.done.value = Math.min(1, passedMs / TEST_MS);
    if (passedMs < TEST_MS) void this.ask();
    else if (passedMs > TEST_MS + PATIENCE_MS || !this.tripsMs.includes(Infinity)) {
      this.end();
      this.found.value = judge(this.tripsMs, this.arrivals);
    }
  }

  private async ask(): Promise<void> {
    const sentMs = performance.now();
    const index = this.tripsMs.push(Infinity) - 1;
    try {
      const { court_ms } = await this.court.ask<{ court_ms: number | null }>("ping");
      this.tripsMs[index] = performance.now() - sentMs + (court_ms ?? 0);
    } catch {
      // It stays without an answer.
    }
  }
}
