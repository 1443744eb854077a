/** The WebSocket to the gateway: opens again for ever, and pairs requests with their replies. */

import { signal } from "@preact/signals";
import { type Message, type Mistake, type Request, readMessage, writeRequest } from "./wire";

/** The gateway, or the court behind it, said no. */
export class Refused extends Error {
  readonly mistakes: Mistake[];

  constructor(message: string, mistakes: Mistake[] = []) {
    super(message);
    this.mistakes = mistakes;
  }
}

/** How the socket is; `attempt` counts those since it was open last. */
export interface SocketState {
  open: boolean;
  attempt: number;
  /** `performance.now()` when it broke, or was first tried. */
  sinceMs: number;
}

interface Waiting {
  resolve(value: unknown): void;
  reject(error: Refused): void;
}

const RETRY_FIRST_MS = 250;
const RETRY_MOST_MS = 3000;
/** A gateway sends frames or at least a link message every second: so long a silence is a break. */
const SILENCE_MS = 5000;
const LOOK_MS = 1000;

export class Connection {
  readonly state = signal<SocketState>({ open: false, attempt: 0, sinceMs: performance.now() });
  private socket: WebSocket | null = null;
  private lastId = 0;
  private heardMs = 0;
  private ended = false;
  private readonly waiting = new Map<number, Waiting>();

  /**
   * @param url Of the WebSocket.
   * @param opened Called on each opening, before anything is taken in: says what to watch.
   * @param take Takes in a message that is not a reply.
   */
  constructor(
    private readonly url: string,
    private readonly opened: () => void,
    private readonly take: (message: Message, arrivedMs: number) => void,
  ) {
    this.open();
    setInterval(() => this.look(), LOOK_MS);
  }

  /** Ask the gateway; rejects with `Refused`. */
  ask<T = unknown>(what: Request, fields: object = {}): Promise<T> {
    if (this.socket?.readyState !== WebSocket.OPEN) {
      return Promise.reject(new Refused("not connected"));
    }
    const id = ++this.lastId;
    const reply = new Promise<T>((resolve, reject) => {
      this.waiting.set(id, { resolve: resolve as (value: unknown) => void, reject });
    });
    this.socket.send(writeRequest(id, what, fields));
    return reply;
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
      this.state.value = { open: true, attempt: 0, sinceMs: performance.now() };
      this.opened();
    };
    socket.onmessage = (event: MessageEvent<ArrayBuffer>) => {
      this.heardMs = performance.now();
      const message = readMessage(new Uint8Array(event.data));
      if (message?.kind === "reply") this.settle(message.body);
      else if (message) this.take(message, this.heardMs);
    };
    socket.onclose = () => this.lost(socket);
  }

  private lost(socket: WebSocket): void {
    if (socket !== this.socket) return;
    this.socket = null;
    for (const { reject } of this.waiting.values()) reject(new Refused("the connection broke"));
    this.waiting.clear();
    if (this.ended) return;
    const { open, attempt, sinceMs } = this.state.value;
    this.state.value = {
      open: false,
      attempt: attempt + 1,
      sinceMs: open ? performance.now() : sinceMs,
    };
    // Not all pages of a hall at the same moment.
    const wait =
      Math.min(RETRY_MOST_MS, RETRY_FIRST_MS * 2 ** attempt) * (0.7 + 0.6 * Math.random());
    setTimeout(() => this.open(), wait);
  }

  /** A socket can be dead without a word, such as behind a cable that was pulled. */
  private look(): void {
    const socket = this.socket;
    if (!socket || performance.now() - this.heardMs < SILENCE_MS) return;
    socket.close();
    this.lost(socket);
  }

  private settle(reply: (Message & { kind: "reply" })["body"]): void {
    const waiting = this.waiting.get(reply.id);
    this.waiting.delete(reply.id);
    if (reply.ok) waiting?.resolve(reply.value);
    else waiting?.reject(new Refused(reply.error, reply.mistakes ?? []));
  }
}
