import { defineConfig } from "vitest/config";

export default defineConfig({
  test: { dir: "../tests/web", include: ["**/*.test.ts"], environment: "happy-dom" },
  server: { fs: { allow: [".."] } },
});
