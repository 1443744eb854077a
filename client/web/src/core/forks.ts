/** Asks the gateway to go on with one of its recordings: a fork, which is a recording too. */

import { anySecret, ownPage } from "./address";
import type { Phrase } from "./phrase";
import type { ForkChanges } from "./wire";

/** How to go on. */
export interface ForkAsk {
  /** First beat that may differ from the recording. */
  beat: number;
  /** Number of an event that is taken back; null: none. */
  take_back: number | null;
  /** Seats whose robots are put back at their start place. */
  restart: string[];
  /** For each seat a bot, or `RECORDED`. */
  players: string[];
}

/** Whether this page may ask for forks: the tab has a secret. */
export function mayFork(): boolean {
  return ownPage === null && anySecret() !== null;
}

/** The bots that can go on with a recording; rejects with an `Error` in the reader's language. */
export async function botsFor(name: string, language: string): Promise<string[]> {
  const found = (await ask(name, language)) as { bots: string[] };
  return found.bots;
}

/**
 * Play a fork; returns the name of its recording. Rejects as `botsFor` does.
 *
 * @param signal Aborted when nobody waits for the fork any more; then this rejects too.
 */
export async function fork(
  name: string,
  asked: ForkAsk,
  language: string,
  signal: AbortSignal,
): Promise<string> {
  const sent = { method: "POST", body: JSON.stringify(asked), signal };
  const made = (await ask(name, language, sent)) as { name: string };
  return made.name;
}

async function ask(name: string, language: string, sent: RequestInit = {}): Promise<unknown> {
  const response = await fetch(`recordings/${encodeURIComponent(name)}/forks`, {
    ...sent,
    headers: { "X-Lacoc-Key": anySecret() ?? "", "Accept-Language": language },
  });
  if (!response.ok) throw new Error((await response.text()).trim());
  return response.json();
}

/** Say how a fork was made, as `lacoc replay info` does; null: its record does not say. */
export function how(changes: ForkChanges | null): Phrase[] | null {
  if (!changes) return null;
  const { seats, take_back, restart, variant } = changes;
  const played = seats.some(({ bot, script }) => bot || script);
  return [
    ...(played ? seats.map(player) : []),
    ...(take_back === null ? [] : [{ code: "forked.take-back", values: { event: take_back } }]),
    ...restart.map((seat) => ({ code: "forked.restart", values: { seat } })),
    ...(variant ? [{ code: "forked.variant", values: { variant } }] : []),
  ];
}

function player({ seat, bot, script }: ForkChanges["seats"][number]): Phrase {
  if (bot) return { code: "forked.bot", values: { seat, bot } };
  if (script) return { code: "forked.script", values: { seat, script } };
  return { code: "forked.recorded", values: { seat } };
}
