import { defineConfig } from "vite";
import { leanThree } from "./src/scene/lean_three";

/** What people learn with is large, and no page of a match needs it. */
const NO_LESSON = /^(?!.*[\\/](?:leg|design|class)[\\/.])/;
const BASE =
  /^(?!.*[\\/](?:leg|design|class)[\\/.]).*(?:node_modules|[\\/]src[\\/](?:core|i18n)[\\/])/;
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
            { name: "base", test: BASE, ...SHARED },
            { name: "shared", test: NO_LESSON, ...SHARED },
          ],
        },
      },
    },
  },
});
