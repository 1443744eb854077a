/** A page's claim to a seat: its state, and how each event changes it. Pure. */

import type { Refused } from "./connection";
import type { Phrase } from "./phrase";

/** The seat that a person wants to hold; the page asks for it again after every break. */
export interface Wish {
  court: string;
  seat: string;
  /** null: the token that was named on the command line. */
  token: string | null;
  name: string;
}

/**
 * The state of a claim.
 *
 * - `none`: nobody wants a seat.
 * - `joining`: a person asked for a seat and does not have it yet; a refusal is shown at once.
 * - `holding`: the seat was granted; the page asks for it again after every break, in silence.
 * - `changing`: as `holding`, with new files; a refusal is shown at once.
 * - `leaving`: the person gives the seat up; the court has not answered yet.
 * - `left`: the person gave the seat up.
 * - `lost`: the court gave the seat to another page, or does not accept it any more.
 */
export type ClaimState = "none" | "joining" | "holding" | "changing" | "leaving" | "left" | "lost";

/** What can happen to a claim. */
export type ClaimEvent =
  /** The person asks for a seat. */
  | { is: "join"; wish: Wish }
  /** The person brings new files. `renews`: the seat is given up first (practice). */
  | { is: "change"; renews: boolean }
  /** The person gives the seat up. */
  | { is: "leave" }
  /** The person goes back to the card, or a team's match is over or was taken back. */
  | { is: "forget" }
  /** The files are others than those that were sent: what was wrong in those is old. */
  | { is: "mended" }
  /** There is a court that can be asked for the seat, and the page does not hold it. */
  | { is: "open" }
  /** The court grants what was asked for. `index`: of the seat. */
  | { is: "granted"; wish: Wish; index: number }
  /** The court did not grant it. `broke`: the connection ended, so nobody knows. */
  | { is: "failed"; wish: Wish; refusal: Refused; broke: boolean }
  /** The pause after a failed request is over. */
  | { is: "rested" }
  /** The court tells that the seat is not this page's any more. */
  | { is: "taken"; why: Phrase }
  /** The court took the seat back. */
  | { is: "released" }
  /** The court did not take the seat back, and the page holds it still. */
  | { is: "kept" };

/**
 * Actions that the page must take.
 *
 * - `ask`: send the join.
 * - `begin`: the controller is new; the seat is held from now on.
 * - `rest`: wait a moment before the next request.
 * - `drop`: the gateway gave up the older hold, too; no seat is held.
 * - `renew`: give the seat up silently; the page then asks for it again.
 * - `release`: give the seat up.
 * - `clear`: forget the keys that were pressed.
 */
export type ClaimEffect = "ask" | "begin" | "rest" | "drop" | "renew" | "release" | "clear";

export interface Claim {
  readonly state: ClaimState;
  /** Whether a join is under way, or has failed so lately that the next must wait. */
  readonly request: "none" | "sent" | "resting";
  /** What is wanted; null in `none`, `left` and `lost`. */
  readonly wish: Wish | null;
  /** What was wanted before, for "join again". */
  readonly lastWish: Wish | null;
  /** Requests that failed since the last grant, without an answer that says when to try again. */
  readonly tries: number;
  /** Why the last join was refused; null once a person asks again. */
  readonly refusal: Refused | null;
  /** Why the seat was lost; null in every other state. */
  readonly why: Phrase | null;
}

const MOST_TRIES = 8;
/** Refusals that the same request would meet again. */
const FINAL: ReadonlySet<string> = new Set([
  "refused.wrong-token",
  "gateway.no-token",
  "refused.files-too-large",
]);

/** Events as the table has them: a failed join is one of three. */
type Trigger =
  | Exclude<ClaimEvent["is"], "failed" | "rested" | "mended" | "change">
  | "change"
  | "renew"
  /** The connection broke. */
  | "unheard"
  /** The same request may be granted later. */
  | "deferred"
  /** The same request will be refused again. */
  | "refused";

type Row = Partial<Record<Trigger, readonly [ClaimState, ...ClaimEffect[]]>>;

const WITHOUT_WISH: Row = {
  join: ["joining"],
  taken: ["lost"],
};

const WITH_WISH: Row = {
  join: ["joining"],
  change: ["changing", "ask"],
  renew: ["changing", "renew"],
  leave: ["leaving", "release"],
  granted: ["holding", "begin"],
  refused: ["none", "drop"],
  taken: ["lost"],
};

/** State by event: the next state, then the actions. An event that is not here changes nothing. */
export const TRANSITIONS: Readonly<Record<ClaimState, Row>> = {
  none: WITHOUT_WISH,
  joining: {
    ...WITH_WISH,
    forget: ["none", "drop"],
    open: ["joining", "ask"],
    unheard: ["joining", "rest"],
    deferred: ["none", "drop"],
  },
  holding: {
    ...WITH_WISH,
    forget: ["none", "drop"],
    open: ["holding", "ask"],
    unheard: ["holding", "rest"],
    deferred: ["holding", "rest"],
  },
  changing: {
    ...WITH_WISH,
    forget: ["none", "drop"],
    open: ["changing", "ask"],
    unheard: ["changing", "rest"],
    deferred: ["none", "drop"],
  },
  leaving: {
    join: ["joining"],
    forget: ["none", "drop"],
    released: ["left", "clear"],
    kept: ["holding"],
    taken: ["lost"],
  },
  left: { ...WITHOUT_WISH, forget: ["none"] },
  // The news may be of the older hold of a seat that was asked for again.
  lost: { ...WITHOUT_WISH, forget: ["none"], granted: ["holding", "begin"] },
};

/** States with a wish. */
const WANTS: ReadonlySet<ClaimState> = new Set(["joining", "holding", "changing", "leaving"]);

/** A claim at the start of a page. `wish` was granted before a reload; null if none was. */
export function claimOf(wish: Wish | null): Claim {
  return {
    state: wish ? "holding" : "none",
    request: "none",
    wish,
    lastWish: null,
    tries: 0,
    refusal: null,
    why: null,
  };
}

/** Take in an event: the claim after it, and what the page has to do, in this order. */
export function step(claim: Claim, event: ClaimEvent): [Claim, readonly ClaimEffect[]] {
  const answered = answer(claim, event);
  // The answer to an older request changes nothing else: that seat was given up since.
  const isAnswer = event.is === "granted" || event.is === "failed";
  if (isAnswer && event.wish !== (claim.wish ?? claim.lastWish)) return [answered, []];
  const trigger = triggerOf(answered, event);
  const [state, ...effects] = (trigger && TRANSITIONS[claim.state][trigger]) ?? [claim.state];
  const todo = effects.filter((effect) => effect !== "ask" || answered.request === "none");
  const next = { ...answered, ...remembered(answered, event, state), state };
  if (todo.includes("ask")) return [{ ...next, request: "sent" }, todo];
  if (todo.includes("rest")) return [{ ...next, request: "resting" }, todo];
  return [next, todo];
}

/** The wish that a reload must find again. */
export function keptWish({ state, wish }: Claim): Wish | null {
  return state === "holding" || state === "changing" ? wish : null;
}

/** Whether the same request would be refused again. */
export function isFinal({ mistakes, why }: Pick<Refused, "mistakes" | "why">): boolean {
  return mistakes.length > 0 || FINAL.has(why.code);
}

/** Note an answer: the join is not under way any more. */
function answer(claim: Claim, event: ClaimEvent): Claim {
  switch (event.is) {
    case "granted":
      return { ...claim, request: "none", tries: 0 };
    case "failed": {
      const counts = !event.refusal.again && !isFinal(event.refusal);
      return { ...claim, request: "none", tries: claim.tries + (counts ? 1 : 0) };
    }
    case "rested":
      return { ...claim, request: "none" };
    default:
      return claim;
  }
}

/** Find an event's column in the table. */
function triggerOf(claim: Claim, event: ClaimEvent): Trigger | null {
  switch (event.is) {
    case "rested":
    case "mended":
      return null;
    case "change":
      return event.renews ? "renew" : "change";
    case "failed": {
      const { refusal, broke } = event;
      if (broke) return "unheard";
      const mayBeGranted = refusal.again || (!isFinal(refusal) && claim.tries < MOST_TRIES);
      return mayBeGranted ? "deferred" : "refused";
    }
    default:
      return event.is;
  }
}

/** The data of the claim after an event that leads to `state`. */
function remembered(claim: Claim, event: ClaimEvent, state: ClaimState): Partial<Claim> {
  if (event.is === "join") return { wish: event.wish, tries: 0, refusal: null, why: null };
  if (event.is === "mended") return claim.refusal?.mistakes.length ? { refusal: null } : {};
  if (WANTS.has(state)) return event.is === "granted" ? { wish: event.wish, why: null } : {};
  const ended = claim.wish;
  return {
    wish: null,
    lastWish: ended ?? claim.lastWish,
    refusal: ended && event.is === "failed" ? event.refusal : claim.refusal,
    why: event.is === "taken" ? event.why : state === "lost" ? claim.why : null,
  };
}
