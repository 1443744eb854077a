/**
 * A match as numbered pieces over HTTP, for a page that only watches and found no place.
 *
 * Any cache on the way can keep a piece, so a crowd of any size costs the gateway nothing. What is
 * shown is 2 to 4 s behind.
 */

import { decode } from "@msgpack/msgpack";
import { answerOf } from "./answer";
import { type Message, PIECE_MS, type PiecesNow, readMessage } from "./wire";

/** A message, and when it is shown, by `performance.now()`. */
export interface Due {
  dueMs: number;
  message: Message;
}

/** Who shows what comes in pieces. */
export interface Shows {
  /**
   * Take what a piece has.
   *
   * @param begins Whether the page begins with this piece; else it goes on from the one before.
   */
  take(messages: readonly Due[], begins: boolean): void;
  /** There is room on a WebSocket again. */
  room(): void;
}

type Packed = [start: Uint8Array[], then: [ms: number, message: Uint8Array][]];

/** The page begins so much later than it could: a lost packet is sent again after a second. */
const SLACK_MS = 350;
/** A piece is asked for so long before it is shown: then it has just become whole. */
const AHEAD_MS = 950 + SLACK_MS;
/** Not all pages of a crowd at the same moment. */
const SPREAD_MS = 200;
const AGAIN_MS = 500;
/** The page begins with the last but one of the pieces that are whole. */
const FIRST = 2;
/** Whoever is further behind than this goes on nearer to the newest piece. */
const BEHIND_MOST = 4;
const LOOK_MS = 10_000;
/** Over such a time the pages of a crowd come back when there is room. */
const RETURN_MS = 20_000;

/** Get a picture in pieces; see `Pieces`. */
export function inPieces(url: string, shows: Shows): Pieces {
  return new Pieces(url, shows);
}

export class Pieces {
  private timer: ReturnType<typeof setTimeout> | undefined;
  private ended = false;
  private run = "";
  private next = 0;
  /** When piece 0 of the run was shown, or would have been. */
  private zeroMs = 0;
  /** Whether the page has nothing to go on from. */
  private begins = true;
  private lookedMs = Number.NEGATIVE_INFINITY;
  private spokenMs = Number.NEGATIVE_INFINITY;
  /** How often this page has cheered since it spoke, by symbol. */
  private cheers: number[] = [];
  /** From when on the page goes back to a WebSocket if there is room. */
  private returnMs = Number.POSITIVE_INFINITY;

  /**
   * @param url Of the picture, without a slash at its end.
   * @param shows Who shows it.
   */
  constructor(
    private readonly url: string,
    private readonly shows: Shows,
  ) {
    void this.go();
  }

  /** Cheer with a symbol: the gateway hears of it when this page speaks next. */
  cheer(symbol: number): void {
    this.cheers[symbol] = (this.cheers[symbol] ?? 0) + 1;
  }

  end(): void {
    this.ended = true;
    clearTimeout(this.timer);
  }

  private async go(): Promise<void> {
    let waitMs = AGAIN_MS;
    try {
      waitMs = await this.step();
    } catch {
      // Nothing answers, or a piece was cut off: the page waits, and asks again.
      this.lookedMs = Number.NEGATIVE_INFINITY;
    }
    if (this.ended) return;
    this.timer = setTimeout(() => void this.go(), waitMs + Math.random() * SPREAD_MS);
  }

  /** Get the next piece; return how long to wait then [ms]. */
  private async step(): Promise<number> {
    if (performance.now() - this.lookedMs > LOOK_MS && !(await this.look())) return AGAIN_MS;
    const reply = await answerOf(`${this.url}/${this.run}/${this.next}`);
    if (reply.status === 404) {
      // It is not whole yet, or nobody has it any more.
      this.lookedMs = Number.NEGATIVE_INFINITY;
      return AGAIN_MS;
    }
    if (!reply.ok) return AGAIN_MS;
    const piece = decode(new Uint8Array(await reply.arrayBuffer())) as Packed;
    if (!this.ended) this.show(piece);
    return this.dueMs() - AHEAD_MS - performance.now();
  }

  /** Look which pieces there are; false: there is nothing to ask for yet. */
  private async look(): Promise<boolean> {
    const reply = await answerOf(`${this.url}/now.json`);
    if (!reply.ok || this.ended) return false;
    const { run, closed, room, share } = (await reply.json()) as PiecesNow;
    if (performance.now() - this.spokenMs > LOOK_MS) this.speak(share);
    this.lookedMs = performance.now();
    if (!room) this.returnMs = Number.POSITIVE_INFINITY;
    else if (this.returnMs === Number.POSITIVE_INFINITY)
      this.returnMs = this.lookedMs + Math.random() * RETURN_MS;
    else if (this.returnMs < this.lookedMs) this.shows.room();
    // With a second in hand: the next piece is whole before the first one has been shown.
    if (closed >= FIRST && (run !== this.run || closed - this.next > BEHIND_MOST)) {
      this.run = run;
      this.next = closed - FIRST;
      this.zeroMs = performance.now() + SLACK_MS - this.next * PIECE_MS;
      this.begins = true;
    }
    if (run === this.run && closed > this.next) return true;
    this.lookedMs = Number.NEGATIVE_INFINITY;
    return false;
  }

  /** Say that this page is here; of a large crowd only a share does, and stands for the others. */
  private speak(share: number): void {
    this.spokenMs = performance.now();
    const cheers = this.cheers;
    this.cheers = [];
    if (Math.random() >= share) return;
    const body = JSON.stringify({ cheers: [...cheers].map((count) => count ?? 0) });
    fetch(`${this.url}/here`, { method: "POST", body }).catch(() => undefined);
  }

  private dueMs(): number {
    return this.zeroMs + this.next * PIECE_MS;
  }

  private show([start, then]: Packed): void {
    // A piece that comes too late is shown at once, and all after it so much later.
    this.zeroMs += Math.max(0, performance.now() - this.dueMs());
    const dueMs = this.dueMs();
    const first = this.begins ? start.map((bytes): [number, Uint8Array] => [0, bytes]) : [];
    const found: Due[] = [];
    for (const [ms, bytes] of [...first, ...then]) {
      const message = readMessage(bytes);
      if (message) found.push({ dueMs: dueMs + ms, message });
    }
    this.shows.take(found, this.begins);
    this.begins = false;
    this.next++;
  }
}
