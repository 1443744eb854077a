/** Takes the page anew: after the server was updated, parts of the old one can't be loaded. */

const RETRY_MS = 3000;

let waiting = false;

/** Load the page again as soon as the server answers: an error page would stay for ever. */
export async function reloadWhenServed(): Promise<void> {
  if (waiting) return;
  waiting = true;
  for (;;) {
    // First of all wait: a page that can't be had must not be asked for without end.
    await new Promise((resolve) => setTimeout(resolve, RETRY_MS));
    try {
      const answer = await fetch(location.pathname, { cache: "no-store" });
      if (answer.ok) break;
    } catch {
      // Not yet.
    }
  }
  location.reload();
}
