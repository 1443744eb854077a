import { defineConfig } from "vite";
import { leanThree } from "./src/scene/lean_three";

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
        // What several pages share is in few files: a page loads at most some kilobytes in vain.
        codeSplitting: {
          groups: [
            {
              name: "shared",
              // What people learn with is large, and no page of a match needs it.
              test: /^(?!.*[\\/](?:leg|design|class)[\\/.])/,
              minShareCount: 2,
              entriesAware: true,
              entriesAwareMergeThreshold: 60_000,
            },
          ],
        },
      },
    },
  },
});
