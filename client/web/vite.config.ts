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
  },
});
