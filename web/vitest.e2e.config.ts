import { defineConfig } from "vitest/config";

export default defineConfig({
  test: {
    dir: "../tests/e2e",
    include: ["**/*.test.ts"],
    testTimeout: 120_000,
    hookTimeout: 120_000,
    fileParallelism: false,
    reporters: ["verbose"],
  },
});
