import { execFile } from "node:child_process";
import { join } from "node:path";
import { promisify } from "node:util";
import { afterAll, beforeAll, expect, test } from "vitest";
import { studyError } from "../../client/examples/harness";
import { outFolder, Server } from "./server";

let server: Server;

beforeAll(async () => {
  server = await Server.start();
});

afterAll(async () => {
  await server?.end();
});

test("TheConnectHarnessRunsAStudyToItsEnd", async () => {
  const progress: number[] = [];
  const study = await studyError(server.url.replace(/\/$/, ""), "cube-tensegrity", (seen) =>
    progress.push(seen.progress),
  );
  expect(progress.at(-1)).toBe(1);
  expect(progress).toEqual([...progress].sort((a, b) => a - b));
  if (study.result?.result.case !== "error") throw new Error("The study is of another kind.");
  const { rows, advice } = study.result.result.value;
  expect(rows.filter(({ pareto }) => pareto).length).toBeGreaterThan(0);
  expect(advice).toContain("For an error of 0.1 mm");
});

test("TheShellHarnessKeepsItsLimits", async () => {
  const script = join(import.meta.dirname, "../../client/examples/harness.sh");
  const env = { ...process.env, OUT: join(outFolder, "harness") };
  const { stdout } = await promisify(execFile)(script, ["cube-tensegrity"], { env });
  expect(stdout).toContain("cube-tensegrity: every limit kept");
});
