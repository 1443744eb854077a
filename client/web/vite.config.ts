import { defineConfig } from "vite";
import { leanThree } from "./src/scene/lean_three";

/** What people learn with: large, and no page of a match needs it. */
const LESSON = /[\\/](?:leg|design|class)[\\/.]/;
/** What people watch and hold an event with: no page of a contestant needs it. */
const EVENT =
  /[\\/](?:core[\\/](?:contest|odds|pieces|replays|rewind|playback|record)|ui[\\/](?:introductions|odds|on_air|papers|playback)|pages[\\/](?:contest|office|watch)[\\/.])/;
const BASE = /node_modules|[\\/]src[\\/](?:core|i18n)[\\/]/;
const isPlayed = (id: string) => !LESSON.test(id) && !EVENT.test(id);
/** What several pages share is in few files: a page loads at most some kilobytes in vain. */
const SHARED = { minShareCount: 2, entriesAware: true, entriesAwareMergeThreshold: 200_000 };

// One page for all paths; each of them loads its own part (src/main.tsx). Addresses are relative,
// so that a published folder can be at any path.
export default defineConfig({
  base: "./",
  plugins: [leanThree()],
  build: {
    outDir: "../lacoc_client/pages",
    emptyOutDir: true,
    target: "es2022",
    chunkSizeWarningLimit: 800,
    reportCompressedSize: true,
    rolldownOptions: {
      output: {
        chunkFileNames: ({ name }) => `assets/${name.split("~")[0]}-[hash].js`,
        assetFileNames: ({ names }) =>
          `assets/${(names[0] ?? "").split("~")[0]!.replace(/\.\w+$/, "")}-[hash][extname]`,
        codeSplitting: {
          groups: [
            // The entry needs this part, and no styles: those of all pages stay the first.
            { name: "base", test: (id) => isPlayed(id) && BASE.test(id), ...SHARED },
            { name: "shared", test: isPlayed, ...SHARED },
            { name: "event", test: EVENT, ...SHARED },
          ],
        },
      },
    },
  },
});
