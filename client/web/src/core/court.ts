/** The page's knowledge of a court, as signals that its parts draw from. */

import { batch, computed, type ReadonlySignal, signal } from "@preact/signals";
import { ownToken, runKey, setting, socketUrl } from "./address";
import { recoloured } from "./colours";
import { Connection, type SocketState } from "./connection";
import { type Match, part } from "./match";
import type { Due, Shows } from "./pieces";
import { type Moment, Timeline } from "./timeline";
import {
  BEATS_PER_S,
  type Crowd,
  type Event,
  type Frame,
  type Health,
  type HeldSeat,
  type Link,
  type Message,
  type Notice,
  type OwnFiles,
  PIECE_MS,
  PROTOCOL,
  type Programme,
  type RefereeState,
  type Request,
  type Scene,
  type Sheet,
  SILENT_AFTER_S,
  sameBytes,
  type Welcome,
} from "./wire";

/** A frame older than this is not shown as live. */
const STALE_MS = 1000 * SILENT_AFTER_S;
/** After this time without a piece the page says why it is not connected. */
const NO_PIECE_MS = 5 * PIECE_MS;
const LOOK_MS = 200;
const PLAYOUT_MS = 20;
/** All that tells how the match stands is shown with the delay, and in its order. */
const DELAYED: ReadonlySet<Message["kind"]> = new Set([
  "frame",
  "event",
  "sheet",
  "scene",
  "link",
  "programme",
]);

/** Why a page that only watches gets its match in pieces: the code of what was said instead. */
const NO_PLACE: ReadonlySet<string> = new Set([
  "gateway.full",
  "page.machine-full",
  "page.no-gateway",
  "page.no-websocket",
]);
/** A frame this much older than what was shown is no repetition: the court has gone back. */
const REPEATS_BEATS = 10 * BEATS_PER_S;

const REACHED: SocketState = { open: true, attempt: 0, refused: null };

/** Where the same match comes in pieces: made for a page that finds no place on a WebSocket. */
export type InPieces = (url: string, shows: Shows) => PieceSource;

interface PieceSource {
  cheer(symbol: number): void;
  end(): void;
}

/** What a page watches: one court, or the first or the second picture of the director. */
export type Watched = "court" | "director" | "aside";

/** A court, watched through a gateway. */
export class Court implements Match {
  readonly welcome = signal<Welcome | null>(null);
  readonly sheet: ReadonlySignal<Sheet | null>;
  readonly scene = signal<Scene | null>(null);
  readonly frame = signal<Frame | null>(null);
  readonly events = signal<readonly Event[]>([]);
  readonly health = signal<Health | null>(null);
  readonly verdict = computed(() => {
    const health = this.health.value;
    return health && health.match === this.frame.value?.match ? health.verdict : null;
  });
  readonly link = signal<Link | null>(null);
  /** What the organiser tells all; null until the gateway says so. */
  readonly notice = signal<Notice | null>(null);
  /** Who watches; null until the gateway says so. */
  readonly crowd = signal<Crowd | null>(null);
  readonly seat = signal<HeldSeat | null>(null);
  /** What the director shows in this picture; null where the page follows a court. */
  readonly programme = signal<Programme | null>(null);
  readonly referee = signal<RefereeState | null>(null);
  /** The files on this machine; null until the gateway has sent them. */
  readonly ownFiles = signal<OwnFiles | null>(null);
  /** Frames that came in the last second. */
  readonly framesHz = signal(0);
  /** True once there was a frame; does not change with each frame. */
  readonly begun = part(this, () => true, false);
  /** True if the picture is live. */
  readonly live = signal(false);
  /** The gateway speaks another version: only loading the page again helps. */
  readonly outdated = signal(false);
  /** How much later than the court everything is shown [ms]. */
  readonly behindMs: ReadonlySignal<number>;
  readonly timeline: Timeline;
  readonly connection: Connection;
  /** How the page hears of the court: by its socket, or in pieces as long as they come. */
  readonly reached: ReadonlySignal<SocketState>;
  /** The sheet as the court has it. */
  private readonly published = signal<Sheet | null>(null);
  private scenes: { hash: Uint8Array; scene: Scene }[] = [];
  private log: number | null = null;
  private arrivedMs = 0;
  private arrivals: number[] = [];
  private held: { dueMs: number; take: () => void }[] = [];
  private pieces: PieceSource | null = null;
  /** Whether pieces come now. */
  private readonly piecesCome = signal(false);
  private pieceMs = Number.NEGATIVE_INFINITY;
  /** What came of a court that was cut to, until there is a frame of it; null: no cut is open. */
  private coming: (() => void)[] | null = null;

  /**
   * @param hz Frames a second to ask for.
   * @param delayMs Everything is shown so much later, scores and events too: for a stream that
   *   must not help anyone.
   * @param watched Whether to follow one court, or the director.
   * @param inPieces Gets the match in pieces; null: the page acts, so it needs a WebSocket.
   */
  constructor(
    private readonly hz: number,
    readonly delayMs = 0,
    private readonly watched: Watched = "court",
    private readonly inPieces: InPieces | null = null,
  ) {
    this.sheet = recoloured(this.published);
    this.behindMs = computed(() => delayMs + 1000 * (this.programme.value?.behind_s ?? 0));
    this.timeline = new Timeline();
    this.connection = new Connection(
      socketUrl(),
      () => this.watch(),
      (message, arrivedMs) => this.receive(message, arrivedMs),
    );
    this.reached = computed(() => (this.piecesCome.value ? REACHED : this.connection.state.value));
    setInterval(() => this.look(), LOOK_MS);
    if (delayMs || inPieces) setInterval(() => this.playOut(), PLAYOUT_MS);
    if (inPieces && !runKey() && !ownToken()) {
      const refused = computed(() => this.connection.state.value.refused);
      refused.subscribe((why) => {
        if (why && NO_PLACE.has(why.code)) this.beginPieces();
      });
    }
  }

  /** Whether it follows the director, and not one court. */
  get directed(): boolean {
    return this.watched !== "court";
  }

  sample(nowMs: number): Moment | null {
    return this.timeline.sample(nowMs);
  }

  /** Ask the gateway for something; rejects with `Refused`. */
  ask<T = unknown>(what: Request, fields: object = {}): Promise<T> {
    return this.connection.ask<T>(what, fields);
  }

  /** Cheer with a symbol; one that comes too soon has no effect. */
  cheer(symbol: number): void {
    if (this.pieces) this.pieces.cheer(symbol);
    else this.ask("cheer", { symbol }).catch(() => undefined);
  }

  private watch(): Promise<unknown> {
    this.seat.value = null;
    this.referee.value = null;
    this.health.value = null; // what was known before a break
    const { hz, directed: director } = this;
    const aside = this.watched === "aside";
    const court = setting("court") || null;
    return this.ask("watch", { court, director, aside, hz, key: runKey(), token: ownToken() });
  }

  /** Get the match in pieces, until there is room on a WebSocket. */
  private beginPieces(): void {
    this.connection.rest();
    if (this.pieces) return;
    const picture = this.directed ? this.watched : ["court", setting("court")].filter(Boolean);
    const path = [picture].flat().map(encodeURIComponent).join("/");
    this.pieces = this.inPieces!(new URL(`live/${path}`, location.href).href, {
      take: (messages, begins) => this.takePiece(messages, begins),
      room: () => this.connection.wake(),
    });
  }

  private takePiece(messages: readonly Due[], begins: boolean): void {
    const first = messages[0]?.dueMs ?? 0;
    this.piecesCome.value = true; // also without a frame: the director may not have begun
    this.pieceMs = performance.now();
    if (begins) this.forgetLog(first);
    for (const { message, dueMs } of messages)
      this.later(dueMs, (shownMs) => this.take(message, shownMs));
  }

  private endPieces(): void {
    this.pieces?.end();
    this.pieces = null;
    this.piecesCome.value = false;
    this.held = [];
  }

  private forgetLog(arrivedMs: number): void {
    this.later(arrivedMs, () => {
      this.log = null;
    });
  }

  private receive(message: Message, arrivedMs: number): void {
    if (message.kind === "welcome") {
      if (this.pieces) this.endPieces();
      this.forgetLog(arrivedMs); // all events follow
    }
    if (!DELAYED.has(message.kind)) this.take(message, arrivedMs);
    else this.later(arrivedMs, (shownMs) => this.take(message, shownMs));
  }

  /** Do something when the delay has passed; at once where there is none. */
  private later(arrivedMs: number, take: (shownMs: number) => void): void {
    const dueMs = arrivedMs + this.delayMs;
    if (this.delayMs || this.pieces) this.held.push({ dueMs, take: () => take(dueMs) });
    else take(arrivedMs);
  }

  private playOut(): void {
    const nowMs = performance.now();
    let count = 0;
    while (count < this.held.length && this.held[count]!.dueMs <= nowMs) count++;
    for (const { take } of this.held.splice(0, count)) take();
  }

  private take(message: Message, arrivedMs: number): void {
    const { kind } = message;
    const before = this.programme.peek();
    if (message.kind === "programme" && before && before.court !== message.body.court)
      this.coming = [];
    if (!this.coming || !DELAYED.has(kind)) {
      this.apply(message, arrivedMs);
      return;
    }
    this.coming.push(() => this.apply(message, arrivedMs));
    if (kind === "frame" || (message.kind === "link" && !message.body.connected)) this.cut();
  }

  /** Show the court that was cut to, all of it at once: no team may have the other match's score. */
  private cut(): void {
    const coming = this.coming ?? [];
    this.coming = null;
    batch(() => {
      this.log = null;
      this.events.value = [];
      this.frame.value = null;
      this.timeline.reset();
      for (const apply of coming) apply();
    });
  }

  private apply(message: Message, arrivedMs: number): void {
    switch (message.kind) {
      case "frame":
        this.takeFrame(message.body, arrivedMs);
        break;
      case "event":
        this.takeEvent(message.body);
        break;
      case "sheet":
        this.published.value = message.body;
        this.chooseScene();
        break;
      case "scene":
        this.scenes = [...this.scenes.slice(-2), { hash: message.hash, scene: message.body }];
        this.chooseScene();
        break;
      case "welcome":
        this.welcome.value = message.body;
        this.outdated.value = message.body.protocol !== PROTOCOL;
        break;
      case "health":
        this.health.value = message.body;
        break;
      case "link":
        this.takeLink(message.body);
        break;
      case "notice":
        this.notice.value = message.body;
        break;
      case "crowd":
        this.crowd.value = message.body;
        break;
      case "seat":
        this.seat.value = message.body;
        break;
      case "programme":
        this.programme.value = message.body;
        break;
      case "referee":
        this.referee.value = message.body;
        break;
      case "files": {
        const { used, version } = message.body;
        const before = this.ownFiles.peek()?.used ?? version;
        this.ownFiles.value = { ...message.body, used: used ?? before };
        break;
      }
    }
  }

  private takeFrame(frame: Frame, arrivedMs: number): void {
    if (this.pieces && this.wasShown(frame)) return;
    this.arrivedMs = arrivedMs;
    this.arrivals.push(arrivedMs);
    this.timeline.push(frame, arrivedMs);
    this.frame.value = frame;
    this.live.value = true;
  }

  /** Whether a frame is of the seconds that the page saw on a WebSocket before. */
  private wasShown({ match, beat }: Frame): boolean {
    const newest = this.timeline.newest;
    if (newest?.match !== match) return false;
    return beat <= newest.beat && beat > newest.beat - REPEATS_BEATS;
  }

  private takeLink(link: Link): void {
    this.link.value = link;
    // The court was restarted: its time may have gone back.
    if (this.pieces && this.log !== null && link.log !== this.log) this.timeline.reset();
    if (link.log !== this.log && this.events.value.length) this.events.value = [];
    this.log = link.log;
  }

  /**
   * Keep the events in their order: one that was lost on the way may come late, and all come again
   * when the gateway has found its court again.
   */
  private takeEvent(event: Event): void {
    const known = this.events.value;
    if (known.some((one) => one.number === event.number)) return;
    const later = known.findLastIndex((one) => one.number < event.number) + 1;
    this.events.value = [...known.slice(0, later), event, ...known.slice(later)];
  }

  /** The scene that the sheet names, once both are here; never another one. */
  private chooseScene(): void {
    const wanted = this.published.value?.scene;
    const found = wanted && this.scenes.find(({ hash }) => sameBytes(hash, wanted));
    this.scene.value = found ? found.scene : null;
  }

  private look(): void {
    const nowMs = performance.now();
    this.arrivals = this.arrivals.filter((atMs) => nowMs - atMs < 1000);
    this.framesHz.value = this.arrivals.length;
    if (nowMs - this.pieceMs > NO_PIECE_MS) this.piecesCome.value = false;
    if (nowMs - this.arrivedMs > STALE_MS) this.live.value = false;
  }
}
