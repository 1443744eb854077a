/** Where the page of a token goes next. Pure. */

import type { Health, Whereabouts } from "./wire";

/** What the page knows when it decides where to go. */
export interface Situation {
  /** What a court says of the token. */
  there: Whereabouts;
  /** The court that the page is at, and the call that the court has; "": none. */
  court: string;
  call: string;
  /** The seat that is held, or will be held again after a break; "": none. */
  seat: string;
  /** The call that the page plays, or has played; "": none. */
  mine: string;
  /** The match has been official for long enough that its result was seen. */
  seen: boolean;
  /** The seat was given up, or lost to somebody else: the page says so, and has a button. */
  gone: boolean;
  /** Somebody else drives the seat of the call: another page, or a program. */
  driven: boolean;
}

/**
 * What the page does next.
 *
 * - `stay`: nothing changes.
 * - `hold`: the seat is that of the call: the page plays it.
 * - `rest`: the match is over for this page: it gives the seat up and waits.
 * - `join`: take the seat at this court.
 * - `ask`: ask whether to take it from who drives it now.
 * - `go`: go to another court.
 */
export type Move = "stay" | "hold" | "rest" | "join" | "ask" | "go";

/** Decide what the page does next. */
export function nextMove(now: Situation): Move {
  const { there, court, call, seat, mine, seen, gone, driven } = now;
  if (there.open) return there.court === court ? "stay" : "go"; // a person brings name and files
  const isCalled = there.state === "court";
  // Whoever left the seat comes back by the button. A seat that a refusal ended is asked for again.
  if (isCalled && there.call === mine && (seat || gone)) return "stay";
  const isHere = isCalled && there.court === court;
  if (isHere && seat === there.seat && call === there.call) return "hold";
  // The result stays for a while, unless another match has taken its place.
  if ((seat || gone) && mine && call === mine && !seen) return "stay";
  // Nobody took the seat of a match that is no more, such as one that the office took back.
  if (!isCalled) return seat || gone ? "rest" : "stay";
  if (!isHere) return "go";
  if (call !== there.call) return "stay";
  return driven ? "ask" : "join";
}

/** Whoever was heard so lately drives the seat: a robot stands after a second (rules 3). */
const HEARD_MS = 1500;
/** A driver who was heard so long ago may still come back: a bad line, or a court that was killed. */
const BACK_MS = 10_000;

/** Whether somebody holds a seat, and was heard lately. */
export function isDriven(health: Health | null, seat: string | undefined): boolean {
  const link = health?.seats.find(({ id }) => id === seat);
  return Boolean(link?.session) && (link?.heard_ms ?? Number.POSITIVE_INFINITY) < HEARD_MS;
}

/** Remembers that somebody else drives the seat of a call, so that a short silence gives no seat away. */
export class Driver {
  private call = "";
  private heardMs = 0;

  /** Somebody else was heard, who drives the seat of this call. */
  heard(call: string, nowMs: number): void {
    this.call = call;
    this.heardMs = nowMs;
  }

  /** Whether somebody else drives the seat of this call, and may come back. */
  drives(call: string, nowMs: number): boolean {
    return call === this.call && nowMs - this.heardMs < BACK_MS;
  }
}

/** So long a page looks who drives its seat; its own gateway falls silent sooner. */
const LOOK_MS = 3000;

/** Decides whether a page that comes back, such as a tablet that wakes, may take its seat again. */
export class Return {
  private sinceMs: number | null = null;
  private heardMs: number | null = null;

  /**
   * Look at who holds the seat now.
   *
   * @param health The court's, since the page came back; null: none yet.
   * @param seat The seat that the page held.
   * @param session The session with which the page held it; 0: unknown.
   * @returns `ask`: nobody else drives the seat. `wait`: it is not known yet. `yield`: somebody
   *   else has taken it meanwhile, and drives it.
   */
  look(
    health: Health | null,
    seat: string,
    session: number,
    nowMs: number,
  ): "ask" | "wait" | "yield" {
    const found = this.judge(health, seat, session, nowMs);
    if (!health || found !== "wait") this.sinceMs = this.heardMs = null; // each return begins anew
    return found;
  }

  private judge(health: Health | null, seat: string, session: number, nowMs: number) {
    if (session === 0) return "ask";
    if (!health) return "wait";
    const holder = health.seats.find(({ id }) => id === seat)?.session;
    if (!holder || holder === session) return "ask";
    this.sinceMs ??= nowMs;
    this.heardMs ??= nowMs;
    if (isDriven(health, seat)) {
      this.heardMs = nowMs;
      return nowMs - this.sinceMs < LOOK_MS ? "wait" : "yield";
    }
    // A short silence gives no seat away.
    return nowMs - this.heardMs < LOOK_MS ? "wait" : "ask";
  }
}
