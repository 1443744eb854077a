import { defineConfig } from "vite";

// One page for all paths; each of them loads its own part (src/main.tsx).
export default defineConfig({
  base: "/",
  build: {
    outDir: "../lacoc_client/pages",
    emptyOutDir: true,
    target: "es2022",
    chunkSizeWarningLimit: 800,
    reportCompressedSize: true,
  },
});
