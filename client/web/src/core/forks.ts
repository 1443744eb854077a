/** Asks the gateway to go on with one of its recordings: a fork, which is a recording too. */

import { ownPage, runKey } from "./address";

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

/** Whether this page may ask for forks: it was opened with the page key. */
export function mayFork(): boolean {
  return ownPage === null && runKey() !== null;
}

/** The bots that can go on with a recording; rejects with an `Error` in the reader's language. */
export async function botsFor(name: string, language: string): Promise<string[]> {
  const found = (await ask(name, language)) as { bots: string[] };
  return found.bots;
}

/** Play a fork; returns the name of its recording. Rejects as `botsFor` does. */
export async function fork(name: string, asked: ForkAsk, language: string): Promise<string> {
  const made = (await ask(name, language, JSON.stringify(asked))) as { name: string };
  return made.name;
}

async function ask(name: string, language: string, body?: string): Promise<unknown> {
  const response = await fetch(`/recordings/${encodeURIComponent(name)}/forks`, {
    method: body === undefined ? "GET" : "POST",
    headers: { "X-Lacoc-Key": runKey() ?? "", "Accept-Language": language },
    ...(body !== undefined && { body }),
  });
  if (!response.ok) throw new Error((await response.text()).trim());
  return response.json();
}
