/** Asks a server what a page asks for again and again. */

/** A connection that says nothing may stay open for minutes: by then another one was answered. */
const SILENT_MS = 20_000;

/**
 * Get an answer, with its whole body, within some seconds.
 *
 * @throws DOMException if it does not come in that time.
 * @throws TypeError if nobody answers.
 */
export function answerOf(address: string, how: RequestInit = {}): Promise<Response> {
  return fetch(address, { ...how, signal: AbortSignal.timeout(SILENT_MS) });
}
