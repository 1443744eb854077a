/** Gets records into the page: from the server's folder, or from this machine. */

import { ownPage } from "./address";
import { type Odds, readOdds } from "./odds";
import type { MatchRecord, RecordFile } from "./record";
import type { Answer } from "./record.worker";

/** A recording of the server's folder. */
export interface Listed {
  name: string;
  bytes: number;
  /** ISO 8601, UTC. */
  modified: string;
  /** What was played; null: the file does not say. */
  match: Summary | null;
}

/** A match in the list. */
export interface Summary {
  title: string;
  court: string;
  number: number;
  /** ISO 8601, UTC. */
  started: string;
  teams: string[];
  /** Empty while there is no result. */
  scores: number[];
  /** Seat id, "draw", "void", or "" while there is none. */
  winner: string;
  seats: string[];
  /** Id of the match that this is a fork of; "": it is no fork. */
  fork_of: string;
}

/** A record can't be read: the name of a message `replay.bad.…`, and its values. */
export class BadRecord extends Error {
  constructor(
    readonly why: string,
    readonly holes: Record<string, string | number> = {},
  ) {
    super(why);
  }
}

/** Where the recordings are. */
const FOLDER = ownPage ? "records" : "recordings";

/** The address of a recording's replay, beside this page. */
export function replayAddress(name: string): string {
  return `${ownPage ? "replay.html" : "replay"}?file=${encodeURIComponent(name)}`;
}

/** The server's recordings, the newest first. */
export async function listed(): Promise<Listed[]> {
  const response = await ask(FOLDER);
  if (!response.ok) throw new BadRecord("unreachable");
  return (await response.json()) as Listed[];
}

/**
 * Fetch a recording of the server.
 *
 * @param progress Told the part that is here, 0 to 1.
 */
export async function fetched(
  name: string,
  progress: (part: number) => void,
): Promise<RecordFile[]> {
  const response = await ask(`${FOLDER}/${encodeURIComponent(name)}`);
  if (!response.ok || !response.body) throw new BadRecord("missing", { name });
  const total = Number(response.headers.get("Content-Length"));
  const parts: Uint8Array[] = [];
  let length = 0;
  const reader = response.body.getReader();
  try {
    for (let got = await reader.read(); !got.done; got = await reader.read()) {
      parts.push(got.value);
      length += got.value.length;
      if (total) progress(Math.min(1, length / total));
    }
  } catch {
    throw new BadRecord("unreachable");
  }
  const data = new Uint8Array(length);
  let at = 0;
  for (const part of parts) {
    data.set(part, at);
    at += part.length;
  }
  return [{ name, data }];
}

/** The odds of a recording of the server; null: there are none, or none of this match. */
export async function oddsOf(name: string, matchId: string): Promise<Odds | null> {
  if (ownPage) return null; // a published folder has none
  const response = await ask(`${FOLDER}/${encodeURIComponent(name)}/odds`);
  return response.ok ? readOdds(await response.json().catch(() => null), matchId) : null;
}

/** Take in files of this machine. */
export async function dropped(files: readonly File[]): Promise<RecordFile[]> {
  try {
    return await Promise.all(
      files.map(async (file) => ({
        name: file.name,
        data: new Uint8Array(await file.arrayBuffer()),
      })),
    );
  } catch {
    throw new BadRecord("unreadable", { name: files.map(({ name }) => name).join(", ") });
  }
}

/** Read a match in a worker; rejects with `BadRecord`. */
export function readBeside(files: RecordFile[]): Promise<MatchRecord> {
  const worker = new Worker(new URL("./record.worker.ts", import.meta.url), { type: "module" });
  const answer = new Promise<MatchRecord>((resolve, reject) => {
    worker.onmessage = ({ data }: MessageEvent<Answer>) => {
      if ("record" in data) resolve(data.record);
      else if ("why" in data) reject(new BadRecord(data.why, data.holes));
      else reject(new BadRecord("fault", { error: data.fault }));
    };
    worker.onerror = (event) =>
      reject(new BadRecord("fault", { error: event.message || "the reader was not loaded" }));
  });
  worker.postMessage(
    files,
    files.map(({ data }) => data.buffer),
  );
  return answer.finally(() => worker.terminate());
}

async function ask(path: string): Promise<Response> {
  try {
    return await fetch(path);
  } catch {
    throw new BadRecord("unreachable");
  }
}
