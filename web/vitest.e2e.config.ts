import { defineConfig } from "vitest/config";

// Everything in tests/e2e needs a built phrenicd and Chromium; `--mode screenshot` makes the README's picture.
export default defineConfig(({ mode }) => ({
  test: {
    dir: "../tests/e2e",
    include: [mode === "screenshot" ? "screenshot.ts" : "**/*.test.ts"],
    testTimeout: 120_000,
    hookTimeout: 120_000,
    fileParallelism: false,
    reporters: ["verbose"],
  },
}));
