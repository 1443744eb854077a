/** Reloads the page: after an update of the server, parts of the old one can't be loaded. */

const RETRY_MS = 3000;

let waiting = false;

/** Load the page again as soon as the server answers: an error page would stay for ever. */
export async function reloadWhenServed(): Promise<void> {
  if (waiting) return;
  waiting = true;
  for (;;) {
    // Wait first, so that a page that can't be loaded is not requested in a loop.
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
