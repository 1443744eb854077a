/** Watches a picture in pieces as many pages do, and prints what they showed: node crowd.mjs URL PAGES SECONDS */

const { inPieces } = await import("../../../client/web/src/core/pieces.ts");

const [url, pages, seconds] = process.argv.slice(2);
const GAP_MS = 500;
const TICK_MS = 20;
const epochMs = Date.now() - performance.now();

/** A page: when each frame is shown, by the clock of the day. */
function open() {
  const page = { frames: 0, gaps: 0, backwards: 0, begins: 0, shown: [] };
  let last = null;
  const source = inPieces(url, {
    take(messages, begins) {
      page.begins += begins;
      for (const { dueMs, message } of messages) {
        if (message.kind !== "frame") continue;
        const { beat } = message.body;
        page.frames++;
        if (last && beat < last.beat) page.backwards++;
        if (last && Math.max(dueMs, performance.now() - TICK_MS) - last.dueMs > GAP_MS) page.gaps++;
        last = { beat, dueMs };
        page.shown.push([beat, epochMs + dueMs]);
      }
    },
    room() {},
  });
  return { page, source };
}

const opened = Array.from({ length: Number(pages) }, open);
await new Promise((done) => setTimeout(done, 1000 * Number(seconds)));
for (const { source } of opened) source.end();
const told = JSON.stringify(opened.map(({ page }) => page));
process.stdout.write(told, () => process.exit());
