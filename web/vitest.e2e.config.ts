import { defineConfig } from "vitest/config";

// Everything in tests/e2e needs a built phrenicd and Chromium; `--mode screenshot` makes the README's picture.
export default defineConfig(({ mode }) => ({
  test: {
    dir: "../tests/e2e",
    include: [mode === "screenshot" ? "screenshot.ts" : "**/*.test.ts"],
    testTimeout: 120_000,
    hookTimeout: 120_000,
    // A shared machine may stall a browser: a test that passed only the second time is listed as such.
    retry: process.env.CI === "true" ? 1 : 0,
    fileParallelism: false,
    reporters: ["verbose"],
  },
}));
