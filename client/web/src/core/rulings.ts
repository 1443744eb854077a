/** The referee's changes to score and winner, and the time played, from the events alone. */

import { BEATS_PER_S, type Decision, type Event } from "./wire";

/** The newest declaration of a winner. */
export function declaration(events: readonly Event[]): Event | null {
  return events.findLast(({ data }) => data.decision === "declare") ?? null;
}

/**
 * The decisions that make the score another one than the robots' alone: those that stand.
 * One that was taken back, and what took it back, are not among them.
 */
export function corrections(events: readonly Event[]): Event[] {
  const takenBack = new Set(
    events.flatMap((event) => {
      const decision = decisionOf(event);
      return decision?.type === "take-back" ? [decision.event] : [];
    }),
  );
  const decisions = new Set(
    events.filter(({ kind }) => kind === "decision").map(({ number }) => number),
  );
  return events.filter((event) => {
    const decision = decisionOf(event);
    if (decision?.type === "take-back") return !decisions.has(decision.event);
    const corrects = decision?.type === "adjust" || decision?.type === "set";
    return corrects && !takenBack.has(event.number);
  });
}

/**
 * Whether the referee can still have the match played again: it can be declared void, or followed by
 * another one of the same teams. Where an office opens the matches, an official result stays.
 *
 * @param decisions Why each decision is not legal now; null if it is.
 */
export function canPlayAgain({ abort, next }: Record<string, unknown>): boolean {
  return abort === null || next === null;
}

/** What halted the match: the decision or the fault before its newest halt; null: nothing says. */
export function whyHalted(events: readonly Event[]): Event | null {
  const index = events.findLastIndex(({ data }) => data.after === "HALTED");
  const halt = events[index];
  if (!halt) return null;
  const causes = new Set(["decision", "fault", "rules"]);
  return (
    events.slice(0, index).findLast(({ beat, kind }) => beat === halt.beat && causes.has(kind)) ??
    null
  );
}

/**
 * Whether an event is of a kind that can be taken back (rules 4): captures, flips, strikes, `adjust`
 * and `set`; events of other games name a marker.
 */
export function canGo(event: Event): boolean {
  const decision = event.data.decision;
  if (event.kind === "decision") return decision === "adjust" || decision === "set";
  return typeof event.data.marker === "string";
}

/** Events that do not stand any more, and how they went. */
export function goneEvents(events: readonly Event[]): Map<number, "takenBack" | "vanished"> {
  const gone = new Map<number, "takenBack" | "vanished">();
  for (const event of events) {
    if (event.data.decision !== "take-back") continue;
    const { arguments: given, vanished } = event.data as {
      arguments?: { event?: number };
      vanished?: number[];
    };
    for (const number of vanished ?? []) gone.set(number, "vanished");
    if (given?.event) gone.set(given.event, "takenBack");
  }
  return gone;
}

/** Who comes and goes: after the end of a match that is no news. */
const COMING_AND_GOING = new Set(["join", "leave", "silent", "heard"]);

/**
 * The events as people read them. Once the referee has made the result official, the court's advice
 * to play again falls away, and nobody needs to know that the teams have moved on.
 */
export function toldEvents(events: readonly Event[]): readonly Event[] {
  const official = events.find(({ data }) => data.after === "OFFICIAL");
  if (!official) return events;
  return events.filter(
    ({ kind, number }) =>
      kind !== "advice" && !(number > official.number && COMING_AND_GOING.has(kind)),
  );
}

/** The decision of an event, with its arguments; null for any other event. */
export function decisionOf({ data }: Event): Decision | null {
  if (typeof data.decision !== "string") return null;
  return { ...(data.arguments as object), type: data.decision } as Decision;
}

/**
 * Ticks that were played: those on the clock when play last stopped, and the time that the referee
 * gave until then. `Record.given_s` counts it in the same way.
 */
export function playedTicks(events: readonly Event[]): number {
  let given_s = 0;
  let played = 0;
  let isPlaying = false;
  for (const event of events) {
    const decision = decisionOf(event);
    if (decision?.type === "clock") {
      // Records of protocol 1 have `seconds`, which took time away.
      given_s += Number(decision.gives_s ?? 0) - Number(decision.seconds ?? 0);
    }
    if (event.kind !== "phase") continue;
    if (isPlaying) played = event.clock_ticks + Math.round(given_s * BEATS_PER_S);
    isPlaying = event.data.after === "PLAYING";
  }
  return played;
}
