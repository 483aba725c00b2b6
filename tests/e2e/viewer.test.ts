import type { Browser } from "playwright-core";
import { afterAll, beforeAll, beforeEach, describe, expect, test } from "vitest";
import { endAll, startAll, ViewerPage } from "./browser";
import { canvasPicture, changedFraction } from "./pixels";
import type { Server } from "./server";

let server: Server;
let browser: Browser;
let viewer: ViewerPage;

beforeAll(async () => {
  [browser, server] = await startAll();
  viewer = await ViewerPage.open(browser, server.url);
});

afterAll(() => endAll(browser, server));

const play = () => viewer.page.locator('#play[aria-label="Play"]');
const pause = () => viewer.page.locator('#play[aria-label="Pause"]');

/** Waits for this much simulated time [s]. */
async function pass(seconds: number): Promise<void> {
  const until = seconds + (await viewer.page.evaluate(() => window.phrenic!.time()));
  await viewer.page.waitForFunction((time) => window.phrenic!.time() >= time, until, { timeout: 60_000 });
}

/** Returns the highest vertex of the diaphragm in the newest frame. */
async function highestVertex(): Promise<number> {
  return viewer.page.evaluate(() => {
    const hook = window.phrenic!;
    let dome = 0;
    for (let i = 0; i < hook.vertices("diaphragm"); i++)
      if (hook.vertex("diaphragm", i)[2] > hook.vertex("diaphragm", dome)[2]) dome = i;
    return dome;
  });
}

/** Returns the range of height of a vertex of the diaphragm during `seconds` of simulated time [m]. */
async function travel(vertex: number, seconds: number): Promise<number> {
  return viewer.page.evaluate(
    async ({ vertex, seconds }) => {
      const hook = window.phrenic!;
      let [low, high] = [Infinity, -Infinity];
      for (const start = hook.time(); hook.time() < start + seconds;) {
        const z = hook.vertex("diaphragm", vertex)[2];
        [low, high] = [Math.min(low, z), Math.max(high, z)];
        await new Promise((resolve) => setTimeout(resolve, 30));
      }
      return high - low;
    },
    { vertex, seconds },
  );
}

/** Returns the largest distance between corresponding points [m]. */
function greatestMove(a: [number, number, number][], b: [number, number, number][]): number {
  return Math.max(...a.map((p, i) => Math.hypot(p[0] - b[i][0], p[1] - b[i][1], p[2] - b[i][2])));
}

describe("the thorax in the browser", () => {
  test("IsLive", async () => {
    await viewer.waitForLink("live");
    const bodies = await viewer.page.evaluate(() => window.phrenic!.bodies());
    expect(bodies).toContain("diaphragm");
    expect(bodies.length).toBeGreaterThan(30);
    expect(await viewer.page.textContent("#disclaimer")).toBe("Research and teaching; not for clinical use");
  });

  test("MovesTheVerticesOfTheDiaphragm", async () => {
    const before = await viewer.sample("diaphragm");
    // The dome moves within some part of a breath, whatever the phase at the start.
    const moved = async () => greatestMove(before.points, (await viewer.sample("diaphragm")).points);
    await expect.poll(moved, { timeout: 90_000, interval: 500 }).toBeGreaterThan(0.002);
  });

  test("MovesThePixelsOfTheDiaphragm", async () => {
    const boxes = viewer.page.locator('.layer-name input[type="checkbox"]');
    const others = viewer.page.locator(".layer-name", { hasNotText: "Diaphragm" }).locator("input");
    expect(await boxes.count()).toBeGreaterThan(3);
    for (const box of await others.all()) await box.uncheck();
    // Frames are drawn as fast as the machine allows, so the test polls until a change is visible.
    const first = await canvasPicture(viewer);
    const changed = async () => changedFraction(browser, first, await canvasPicture(viewer));
    await expect.poll(changed, { timeout: 90_000, interval: 1000 }).toBeGreaterThan(0.005);
    await viewer.saveScreenshot("diaphragm");
    for (const box of await others.all()) await box.check();
  });

  test("BreathForceChangesTheMotion", async () => {
    // Short breaths, since a loaded machine may simulate slower than real time.
    await viewer.type("breathLength", 2);
    await pass(1);
    // The same vertex is used for both measurements, since the highest vertex changes during a breath.
    const dome = await highestVertex();
    const quiet = await travel(dome, 2.1);
    await viewer.type("breathForce", 2);
    // One breath until the new force has its full effect.
    await pass(2);
    const strong = await travel(dome, 2.1);
    await viewer.page.click('[aria-label="Reset breath force"]');
    await viewer.page.click('[aria-label="Reset breath length"]');
    await viewer.page.waitForFunction(
      () =>
        document.querySelector<HTMLInputElement>("#parameter-breathForce-entry")?.value === "1" &&
        document.querySelector<HTMLInputElement>("#parameter-breathLength-entry")?.value === "4",
    );
    expect(quiet).toBeGreaterThan(0.003);
    expect(strong).toBeGreaterThan(1.3 * quiet);
  }, 240_000);
});

describe("the buttons", () => {
  beforeEach(async () => {
    if (await play().isVisible()) await play().click();
    await pause().waitFor();
  });

  test("PauseHoldsTheTickAndPlayContinues", async () => {
    await pause().click();
    await play().waitFor();
    const held = await server.restingTick();
    await viewer.waitForExactTick(held);
    await viewer.page.waitForTimeout(700);
    expect(await viewer.tick()).toBe(held);
    await play().click();
    await viewer.waitForTick(held);
  });

  test("StepAdvancesByTheChosenTicks", async () => {
    await pause().click();
    await play().waitFor();
    const held = await server.restingTick();
    await viewer.page.selectOption("#stride", "10");
    await viewer.page.click("#step");
    await viewer.waitForExactTick(held + 10);
    expect(await server.restingTick()).toBe(held + 10);
  });

  test("ResetGoesBackToTheStart", async () => {
    await pause().click();
    await play().waitFor();
    await viewer.page.click("#reset");
    await viewer.waitForExactTick(0);
    expect(await viewer.page.evaluate(() => window.phrenic!.time())).toBe(0);
  });

  test("SpeedChangesThePace", async () => {
    await viewer.page.selectOption("#speed", "0.1");
    await viewer.page.waitForTimeout(1000);
    const pace = await viewer.page.evaluate(async () => {
      const [time, wall] = [window.phrenic!.time(), performance.now()];
      await new Promise((resolve) => setTimeout(resolve, 3000));
      return (window.phrenic!.time() - time) / ((performance.now() - wall) / 1000);
    });
    await viewer.page.selectOption("#speed", "1");
    expect(pace).toBeGreaterThan(0.03);
    expect(pace).toBeLessThan(0.2);
  });

  test("APresetIsAppliedAndShownAsPressed", async () => {
    const preset = (name: string) => viewer.page.locator(`#presets button:text-is("${name}")`);
    const names = await viewer.page.locator("#presets button").allTextContents();
    expect(names).toHaveLength(33);
    expect(names).toEqual(expect.arrayContaining(["Quiet, supine", "Deep breath", "Sniff", "Right palsy", "COPD"]));
    const breathLength = async () => (await server.session()).parameters.breath_length;
    await preset("Panting").click();
    await expect.poll(breathLength, { timeout: 10_000 }).toBe(0.6);
    await viewer.page.waitForSelector('#presets button[aria-pressed="true"]:text-is("Panting")');
    await viewer.saveScreenshot("presets");
    await preset("Quiet, supine").click();
    await viewer.page.waitForSelector('#presets button[aria-pressed="true"]:text-is("Quiet, supine")');
    expect(await viewer.value("breathLength")).toBe("4");
  });

  test("ShiftDragPullsTheTissueUntilItIsReleased", async () => {
    const box = (await viewer.page.locator("#view").boundingBox())!;
    const [x, y] = [box.x + box.width / 2, box.y + box.height / 2];
    const pulls = async () => ((await server.session()).pulls ?? []) as { body: string }[];
    await viewer.page.keyboard.down("Shift");
    await viewer.page.mouse.move(x, y);
    await viewer.page.mouse.down();
    await viewer.page.mouse.move(x + 40, y - 20, { steps: 4 });
    await expect
      .poll(async () => (await pulls()).map(({ body }) => body), {
        timeout: 10_000,
      })
      .toEqual(["diaphragm-middle"]);
    await viewer.page.waitForSelector("#pulls:not([hidden])");
    expect(await viewer.page.textContent("#force:not([hidden])")).toMatch(/^\d+\.\d\d N$/);
    await viewer.saveScreenshot("pull");
    await viewer.page.mouse.up();
    await viewer.page.keyboard.up("Shift");
    await expect.poll(async () => (await pulls()).length, { timeout: 10_000 }).toBe(0);
  });

  test("TheIntegratorChangesDuringPlayback", async () => {
    await viewer.page.selectOption("#parameter-integrator", {
      label: "Velocity Verlet",
    });
    await expect
      .poll(async () => (await server.session()).parameters.integrator, {
        timeout: 10_000,
      })
      .toBe("INTEGRATOR_VELOCITY_VERLET");
    await viewer.waitForTick(await viewer.tick());
    await viewer.page.click('[aria-label="Reset integrator"]');
    await viewer.page.waitForFunction(
      () => document.querySelector<HTMLSelectElement>("#parameter-integrator")?.value === "1",
    );
  });

  test("OverlaysAreDrawn", async () => {
    await pause().click();
    await play().waitFor();
    await viewer.page.locator("#transparency").fill("70");
    await viewer.page.waitForTimeout(1500);
    const plain = await canvasPicture(viewer);
    for (const kind of ["wireframe", "links", "lines", "attachments"]) {
      await viewer.page.check(`#show-${kind}`);
      await viewer.page.waitForTimeout(1500);
      expect(await changedFraction(browser, plain, await canvasPicture(viewer)), kind).toBeGreaterThan(0.0005);
      await viewer.saveScreenshot(`overlay-${kind}`);
      await viewer.page.uncheck(`#show-${kind}`);
    }
    await viewer.page.locator("#transparency").fill("0");
  });
});

describe("the report", () => {
  test("ShowsWhatRunsAndTheLargestStableStep", async () => {
    await viewer.page.click('summary:has-text("Scene report")');
    const text = await viewer.page.textContent(".report");
    expect(text).toContain("rigid links");
    expect(text).toMatch(/Largest stable step [0-9.]+ ms/);
    await viewer.saveScreenshot("report");
    await viewer.page.click('summary:has-text("Scene report")');
  });
});

test("ThePageOnlyContactsItsServerWithoutConsoleErrors", () => {
  expect([...viewer.origins]).toEqual([new URL(server.url).origin]);
  expect(viewer.consoleErrors).toEqual([]);
});

// Must be the last test, since it leaves the page.
test("ClosingThePageReleasesAPull", async () => {
  const pulls = async () => ((await server.session()).pulls ?? []) as { body: string }[];
  const box = (await viewer.page.locator("#view").boundingBox())!;
  const [x, y] = [box.x + box.width / 2, box.y + box.height / 2];
  await viewer.page.keyboard.down("Shift");
  await viewer.page.mouse.move(x, y);
  await viewer.page.mouse.down();
  await viewer.page.mouse.move(x + 40, y - 20, { steps: 4 });
  await expect.poll(async () => (await pulls()).length, { timeout: 10_000 }).toBe(1);
  await viewer.page.goto("about:blank");
  await expect.poll(async () => (await pulls()).length, { timeout: 10_000 }).toBe(0);
});
