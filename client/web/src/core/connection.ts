/** The WebSocket to the gateway: opens again for ever, and pairs requests with their replies. */

import { signal } from "@preact/signals";
import type { Phrase } from "./phrase";
import {
  type BadReply,
  type Message,
  type Mistake,
  type Request,
  readMessage,
  TRY_LATER,
  writeRequest,
} from "./wire";

/** The gateway, or the court behind it, said no. */
export class Refused extends Error {
  /** In files. */
  readonly mistakes: readonly Mistake[];
  /** It is the token: to show it again is of no use. */
  readonly tokenRefused: boolean;
  /** The court can't take it now: the same may be taken later. */
  readonly again: boolean;

  /**
   * @param why The reason.
   * @param reply The gateway's, where it is one.
   */
  constructor(
    readonly why: Phrase,
    reply: Partial<BadReply> = {},
  ) {
    super(why.code);
    this.mistakes = reply.mistakes ?? [];
    this.tokenRefused = reply.token_refused ?? false;
    this.again = reply.again ?? false;
  }
}

/** The answer is missing, here or at the gateway: nobody here knows whether it was done. */
export class Unanswered extends Refused {}

/** The state of the socket. */
export interface SocketState {
  open: boolean;
  /** Counts those since the page was greeted last: a gateway may open and send it away. */
  attempt: number;
  /** Why the gateway did not greet the page; null if it did. Holds until it does. */
  refused: Phrase | null;
}

interface Waiting {
  resolve(value: unknown): void;
  reject(error: Refused): void;
}

const RETRY_FIRST_MS = 250;
const RETRY_MOST_MS = 3000;
/** How much later a page comes again that was sent away with `TRY_LATER`. */
const LATER_MS = 10_000;
/** A gateway sends a frame or a link message every second: a longer silence means a break. */
const SILENCE_MS = 5000;
const LOOK_MS = 1000;
/** After so many attempts, and then each time again, the page looks what stands in the way. */
const DOUBTS = 3;
/** What an answer to a usual request means, by its status, where no WebSocket opens. */
const IN_THE_WAY: Readonly<Record<number, string>> = {
  403: "page.not-let-in",
  426: "page.no-websocket",
  429: "page.machine-full",
  502: "page.no-gateway",
  503: "page.no-gateway",
  504: "page.no-gateway",
};

export class Connection {
  readonly state = signal<SocketState>({ open: false, attempt: 0, refused: null });
  private socket: WebSocket | null = null;
  private lastId = 0;
  private heardMs = 0;
  private ended = false;
  private rests = false;
  private retry: ReturnType<typeof setTimeout> | undefined;
  /** What answered in the gateway's place; said if the next opening fails too. */
  private inTheWay: Phrase | null = null;
  private readonly waiting = new Map<number, Waiting>();

  /**
   * @param url Of the WebSocket.
   * @param greet Called on each opening, before anything is taken in: says what to watch.
   * @param take Takes in a message that is not a reply.
   */
  constructor(
    private readonly url: string,
    private readonly greet: () => Promise<unknown>,
    private readonly take: (message: Message, arrivedMs: number) => void,
  ) {
    this.open();
    setInterval(() => this.look(), LOOK_MS);
  }

  /** Ask the gateway; rejects with `Refused`. */
  ask<T = unknown>(what: Request, fields: object = {}): Promise<T> {
    if (this.socket?.readyState !== WebSocket.OPEN) {
      return Promise.reject(new Refused({ code: "page.not-connected" }));
    }
    const id = ++this.lastId;
    const reply = new Promise<T>((resolve, reject) => {
      this.waiting.set(id, { resolve: resolve as (value: unknown) => void, reject });
    });
    this.socket.send(writeRequest(id, what, fields));
    return reply;
  }

  /** Greet once more, such as with what somebody has typed since. */
  async greetAgain(): Promise<void> {
    // Where it is not open now, it greets when it is.
    if (this.socket?.readyState === WebSocket.OPEN) await this.begin(this.socket);
  }

  /** Try no more until it is told to. */
  rest(): void {
    this.rests = true;
    clearTimeout(this.retry);
  }

  /** Try again after a rest. */
  wake(): void {
    if (!this.rests) return;
    this.rests = false;
    this.open();
  }

  /** Close for good. */
  end(): void {
    this.ended = true;
    this.socket?.close();
  }

  private open(): void {
    const socket = new WebSocket(this.url);
    socket.binaryType = "arraybuffer";
    this.socket = socket;
    this.heardMs = performance.now();
    socket.onopen = () => {
      this.inTheWay = null;
      this.state.value = { ...this.state.value, open: true };
      void this.begin(socket);
    };
    socket.onmessage = (event: MessageEvent<ArrayBuffer>) => {
      this.heardMs = performance.now();
      const message = readMessage(new Uint8Array(event.data));
      if (message?.kind === "reply") this.settle(message.body);
      else if (message) this.take(message, this.heardMs);
    };
    socket.onclose = ({ code }) => this.lost(socket, code === TRY_LATER);
  }

  private async begin(socket: WebSocket): Promise<void> {
    let { attempt } = this.state.value;
    let refused: Phrase | null = null;
    try {
      await this.greet();
      attempt = 0;
    } catch (error) {
      refused = (error as Refused).why;
    }
    // A connection that broke meanwhile was not refused.
    if (socket === this.socket) this.state.value = { open: true, attempt, refused };
  }

  /** @param later Whether the gateway said that the page should come again later. */
  private lost(socket: WebSocket, later: boolean): void {
    if (socket !== this.socket) return;
    this.socket = null;
    for (const { reject } of this.waiting.values())
      reject(new Unanswered({ code: "page.connection-lost" }));
    this.waiting.clear();
    if (this.ended) return;
    const { open, attempt, refused } = this.state.value;
    this.state.value = { open: false, attempt: attempt + 1, refused: this.inTheWay ?? refused };
    if (!open && attempt % DOUBTS === DOUBTS - 1) void this.doubt();
    if (this.rests) return;
    const soon = Math.min(RETRY_MOST_MS, RETRY_FIRST_MS * 2 ** attempt);
    // Not all pages of a hall at the same moment.
    const wait = later ? LATER_MS * (1 + Math.random()) : soon * (0.7 + 0.6 * Math.random());
    this.retry = setTimeout(() => this.open(), wait);
  }

  /**
   * Find out what stands in the way if a proxy answers, but opens no WebSocket.
   * A gateway that came back just now answers a usual request too: it opens the next one.
   */
  private async doubt(): Promise<void> {
    try {
      // A browser says with a POST, as with a WebSocket, which site's page asks.
      const { status } = await fetch(this.url.replace(/^ws/, "http"), { method: "POST" });
      const code = IN_THE_WAY[status];
      if (code && !this.state.peek().open) this.inTheWay = { code };
    } catch {
      // Nothing answers: the page waits, as it says.
    }
  }

  /** A socket can be dead without an event, for example after a cable was pulled. */
  private look(): void {
    const socket = this.socket;
    if (!socket || performance.now() - this.heardMs < SILENCE_MS) return;
    socket.close();
    this.lost(socket, false);
  }

  private settle(reply: (Message & { kind: "reply" })["body"]): void {
    const waiting = this.waiting.get(reply.id);
    this.waiting.delete(reply.id);
    if (reply.ok) waiting?.resolve(reply.value);
    else waiting?.reject(new (reply.unanswered ? Unanswered : Refused)(reply.error, reply));
  }
}
