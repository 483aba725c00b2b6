import { resolve } from "node:path";
import { defineConfig } from "vitest/config";

// All tests in tests/e2e need phrenicd and Chromium; `--mode screenshot` takes the README's screenshots, and
// `--mode bench` measures decoders, `--mode soak` memory over time.
const programs: Record<string, string> = {
  screenshot: "screenshot.ts",
  bench: "bench/decoding.ts",
  soak: "bench/soak.ts",
};

export default defineConfig(({ mode }) => ({
  test: {
    dir: "../tests/e2e",
    env: { PHRENIC_CACHE: resolve(import.meta.dirname, "../build/meshes") },
    include: [programs[mode] ?? "**/*.test.ts"],
    testTimeout: 120_000,
    hookTimeout: 120_000,
    // A shared machine may stall a browser; the report lists tests that passed only in the second attempt.
    retry: process.env.CI === "true" ? 1 : 0,
    // Two at a time: tests mostly wait for what takes its time, such as a breath. Three draw too slowly on two cores.
    maxWorkers: 2,
    reporters: ["verbose"],
  },
}));
