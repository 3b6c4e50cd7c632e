/** Builds the page into dist/; in development the console on :8080 answers for the socket and the 3-D view. */
import react from "@vitejs/plugin-react";
import { defineConfig } from "vite";

const consoleAddress = process.env.WEAVER_CONSOLE ?? "http://127.0.0.1:8080";

export default defineConfig({
  plugins: [react()],
  build: { outDir: "dist", target: "es2022", assetsInlineLimit: 0, chunkSizeWarningLimit: 900 },
  server: {
    proxy: {
      "/ws": { target: consoleAddress, ws: true },
      "/viser": { target: consoleAddress, ws: true },
      "/api": { target: consoleAddress },
    },
  },
});
