import { readFileSync } from "node:fs";
import { join } from "node:path";
import { fromJsonString } from "@bufbuild/protobuf";
import type { Browser } from "playwright-core";
import { afterAll, beforeAll, describe, expect, test } from "vitest";
import type { Api } from "../../web/src/connection/api";
import {
  type Claim,
  Claim_Statistic as Statistic,
  type Lesson,
  LessonSchema,
} from "../../web/src/gen/phrenic/v1/lesson_pb";
import type { Parameters } from "../../web/src/gen/phrenic/v1/parameters_pb";
import { presetOf } from "../../web/src/session/lessons";
import { endAll, startAll, ViewerPage } from "./browser";
import { nodeApi } from "./node_api";
import type { Server } from "./server";

const folder = join(import.meta.dirname, "../../web/public/lessons");
const names = JSON.parse(readFileSync(join(folder, "index.json"), "utf8")) as string[];
const read = (name: string) => fromJsonString(LessonSchema, readFileSync(join(folder, `${name}.json`), "utf8"));

let server: Server;
let browser: Browser;
let api: Api;

beforeAll(async () => {
  [browser, server] = await startAll();
  await server.phrenic("pause", "thorax");
  api = nodeApi(server.url);
});

afterAll(() => endAll(browser, server));

/** The measures of a scene over one breath: values by name, one for each sample. */
type Breath = Map<string, number[]>;

/**
 * Time between two samples, and time that passes before them [simulated s]; then every claim is within 1 % of later
 * breaths.
 */
const interval = 0.05;
const settling = 4;

const breaths = new Map<string, Promise<Breath>>();

/** Returns one breath of a scene with a preset and parameters; steps that show the same share it. */
function breathOf(scene: string, preset: string, parameters: Parameters | undefined): Promise<Breath> {
  const key = JSON.stringify([scene, preset, parameters]);
  if (!breaths.has(key)) breaths.set(key, simulate(scene, preset, parameters));
  return breaths.get(key)!;
}

async function simulate(name: string, preset: string, parameters: Parameters | undefined): Promise<Breath> {
  const source = { source: { case: "name" as const, value: name } };
  const { session } = await api.sessions.createSession({ source, preset, parameters });
  const { timeStep, breathLength } = session!.parameters!;
  const ticks = (seconds: number) => BigInt(Math.round(seconds / timeStep!));
  const sessionId = session!.id;
  await api.sessions.stepSession({ sessionId, ticks: ticks(settling) });
  const breath: Breath = new Map();
  for (let time = 0; time < breathLength!; time += interval) {
    const { measures } = await api.sessions.stepSession({ sessionId, ticks: ticks(interval) });
    for (const { name, value } of measures) breath.set(name, [...(breath.get(name) ?? []), value]);
  }
  await api.sessions.deleteSession({ sessionId });
  return breath;
}

/** Returns what a claim reads from a breath, in SI units. Throws Error for an unknown measure. */
function statisticOf({ measure, statistic }: Claim, breath: Breath): number {
  const values = breath.get(measure);
  if (values === undefined) throw new Error(`claims.measure: there is no measure "${measure}"`);
  const volumes = breath.get("lung volume") ?? [];
  const at = (value: number) => values[volumes.indexOf(value)];
  switch (statistic) {
    case Statistic.SWING:
      return Math.max(...values) - Math.min(...values);
    case Statistic.SMALLEST:
      return Math.min(...values);
    case Statistic.LARGEST:
      return Math.max(...values);
    case Statistic.MEAN:
      return values.reduce((sum, value) => sum + value) / values.length;
    case Statistic.INSPIRATION:
      return at(Math.max(...volumes)) - at(Math.min(...volumes));
    case Statistic.UNSPECIFIED:
      throw new Error("claims.statistic is not set");
  }
}

/** Returns the claims of a lesson that the simulation does not keep, in words. */
async function brokenClaims(lesson: Lesson): Promise<string[]> {
  const broken: string[] = [];
  for (const step of lesson.steps) {
    const breath = await breathOf(lesson.scene, presetOf(lesson, step), step.parameters);
    for (const claim of step.claims) {
      const { measure, statistic, minusPreset, minimum = -Infinity, maximum = Infinity } = claim;
      const other = minusPreset === "" ? undefined : await breathOf(lesson.scene, minusPreset, undefined);
      const value = statisticOf(claim, breath) - (other === undefined ? 0 : statisticOf(claim, other));
      const words = `${step.title}: ${measure}, ${Statistic[statistic]}${minusPreset && ` minus ${minusPreset}`}: ${value.toPrecision(3)}`;
      console.log(`${words} in ${minimum} .. ${maximum}`);
      if (!(value >= minimum && value <= maximum)) broken.push(`${words}, not ${minimum} .. ${maximum}`);
    }
  }
  return broken;
}

describe("what the lessons say is true in the simulation", () => {
  test.each(names)("%s", { timeout: 600_000 }, async (name) => {
    expect(await brokenClaims(read(name))).toEqual([]);
  });

  test("AFalseClaimIsFound", { timeout: 600_000 }, async () => {
    const lesson = read("how-we-breathe");
    lesson.steps = lesson.steps.slice(0, 1);
    lesson.steps[0].claims[0].minimum = 0.003;
    expect(await brokenClaims(lesson)).toHaveLength(1);
  });
});

test("ATeacherGoesThroughALessonByKeyboard", async () => {
  const viewer = await ViewerPage.open(browser, `${server.url}?session=thorax&view=student`);
  const { page } = viewer;
  await page.getByText("Lessons", { exact: true }).click();
  const shown = names.filter((name) => read(name).scene === "thorax");
  await expect.poll(() => page.locator("[data-lesson]").count()).toBe(shown.length);
  await page.locator('[data-lesson="paralysis"]').click();
  await page.getByRole("heading", { name: "Two nerves, two domes" }).waitFor();
  await page.keyboard.press("PageDown");
  await page.getByRole("heading", { name: "The right nerve is cut" }).waitFor();
  await expect.poll(async () => (await server.session()).parameters.right_activation).toBe(0);
  expect(new URL(page.url()).search).toContain("lesson=paralysis&step=2");
  await page.getByLabel("The pressure above it falls and it cannot pull against that.").check();
  await page.getByRole("button", { name: "Check" }).click();
  await page.getByText("Right. The lungs draw on both domes.").waitFor();
  expect(await viewer.violations()).toEqual([]);
  for (const [width, height] of [
    [1440, 900],
    [320, 640],
  ]) {
    await page.setViewportSize({ width, height });
    await page.waitForTimeout(1500);
    await viewer.saveScreenshot(`lesson-${width}`);
  }
  // The address opens the same step.
  await page.reload();
  await page.getByRole("heading", { name: "The right nerve is cut" }).waitFor();
  await page.getByRole("button", { name: "Leave" }).click();
  expect(new URL(page.url()).search).not.toContain("lesson");
  expect(viewer.consoleErrors).toEqual([]);
  await viewer.close();
});
