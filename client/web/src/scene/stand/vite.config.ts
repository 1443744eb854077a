import { defineConfig } from "vite";
import { leanThree } from "../lean_three";

// The scene on its own, for its tests and for work on it: no gateway, no court. Not part of what is
// shipped. `npx vite src/scene/stand` serves it, `npx vite build src/scene/stand` builds it.
export default defineConfig({
  base: "./",
  plugins: [leanThree()],
  build: {
    emptyOutDir: true,
    target: "es2022",
    chunkSizeWarningLimit: 800,
  },
});
