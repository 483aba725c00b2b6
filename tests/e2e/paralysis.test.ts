import type { Browser } from "playwright-core";
import { afterAll, afterEach, beforeAll, expect, test } from "vitest";
import { endAll, startAll, ViewerPage } from "./browser";
import type { Server } from "./server";

let server: Server;
let browser: Browser;

beforeAll(async () => {
  [browser, server] = await startAll();
});

// Contexts and sessions that a test leaves open would slow down the next test.
afterEach(async () => {
  for (const context of browser.contexts()) await context.close();
  const { sessions } = JSON.parse(await server.phrenic("sessions", "-o", "json"));
  for (const { id } of sessions) if (id !== "thorax") await server.phrenic("delete", id);
});

afterAll(() => endAll(browser, server));

test("AParalysedHemidiaphragmBesideAHealthyOneTakesLessThanAMinute", async () => {
  const start = Date.now();
  const viewer = await ViewerPage.open(browser, server.url, { width: 1200, height: 720 });
  const { page } = viewer;
  const list = page.getByLabel("Compare with", { exact: true });
  expect(await list.isVisible()).toBe(true);
  await list.selectOption({ label: "Right palsy" });
  await page.waitForURL(/beside=/);
  await viewer.waitForPicture();
  await page.locator("#view-headers").getByText("Right palsy").waitFor();
  const ways = await page.locator(".view-header b").allTextContents();
  expect(ways.toSorted()).toEqual(["Quiet, supine", "Right palsy"]);
  expect(Date.now() - start).toBeLessThan(60_000);
  expect(await page.textContent(".differences")).toContain("right muscle 0");
  // The list now applies to the second view.
  await page.getByLabel("Compare with", { exact: true }).selectOption({ label: "Left palsy" });
  await page.locator("#view-headers").getByText("Left palsy").waitFor();
  expect(viewer.consoleErrors).toEqual([]);
  await viewer.saveScreenshot("paralysis");
});

/** Returns the times of both views from their headers [s]. */
async function times(viewer: ViewerPage): Promise<number[]> {
  const words = await viewer.page.locator(".view-header .time").allTextContents();
  return words.map((each) => Number.parseFloat(each));
}

test("BothViewsBreatheInStepPauseTogetherAndShareColours", async () => {
  const viewer = await ViewerPage.open(browser, server.url, { width: 1200, height: 720 });
  const { page } = viewer;
  await page.getByLabel("Compare with", { exact: true }).selectOption({ label: "Deep breath" });
  await page.waitForURL(/beside=/);
  await viewer.waitForPicture();
  await page.locator("#view-headers").getByText("Deep breath").waitFor();
  const start = await viewer.tick();
  await viewer.waitForTick(start + 400);
  // Software rendering draws two thoraxes a few times a second: the views may show frames that follow each other.
  const [here, there] = await times(viewer);
  expect(Math.abs(here - there)).toBeLessThan(0.5);
  await page.waitForFunction(() => {
    const [first, second] = [...document.querySelectorAll(".view-header .time")].map((each) =>
      Number.parseFloat(each.textContent!),
    );
    return Math.abs(first - second) < 0.1;
  });
  await page.click('#play[aria-label="Pause"]');
  await page.waitForSelector('#play[aria-label="Play"]');
  await page.waitForFunction(() => {
    const [first, second] = [...document.querySelectorAll(".view-header .time")].map((each) => each.textContent);
    return first === second;
  });
  const picture = () => page.locator("#second-view canvas").screenshot();
  const before = await picture();
  await page.selectOption("#coloring-kind", "displacement");
  await page.waitForSelector("#coloring:not([hidden])");
  await expect.poll(async () => (await picture()).equals(before), { timeout: 20_000 }).toBe(false);
  // The dome descent in the header equals the one that the command line prints.
  const { measures } = JSON.parse(await server.phrenic("step", "thorax", "1", "-o", "json"));
  const dome = measures.find(({ name }: { name: string }) => name === "right dome");
  const words = `right dome ${(1000 * Math.abs(dome.value)).toFixed(1)} mm`;
  await page.locator(".view-header").first().getByText(words).waitFor({ timeout: 20_000 });
  expect(viewer.consoleErrors).toEqual([]);
});

test("ReplayDoesNotChangeTheSimulation", async () => {
  const viewer = await ViewerPage.open(browser, server.url, { width: 1200, height: 720 });
  const { page } = viewer;
  if ((await page.locator('#play[aria-label="Play"]').count()) > 0) await page.click("#play");
  await viewer.waitForTick((await viewer.tick()) + 200);
  await page.click('#play[aria-label="Pause"]');
  await page.waitForSelector('#play[aria-label="Play"]');
  await page.waitForTimeout(500);
  const [tick, time] = [await viewer.tick(), await page.textContent("#status-time")];
  await page.focus("#view");
  await page.keyboard.press(",");
  await page.keyboard.press(",");
  await page.waitForSelector("#timeline.replaying");
  await expect.poll(() => page.textContent("#status-time")).not.toBe(time);
  expect(await viewer.tick()).toBe(tick);
  await page.click("#replay-live");
  await expect.poll(() => page.textContent("#status-time")).toBe(time);
  expect(await page.locator("#timeline.replaying").count()).toBe(0);
});

test("ForcesAreReplayed", async () => {
  const viewer = await ViewerPage.open(browser, server.url, { width: 1200, height: 720 });
  const { page } = viewer;
  const note = () => page.textContent("#coloring-note");
  await page.selectOption("#coloring-kind", "force:muscle");
  await page.waitForSelector("#coloring:not([hidden])");
  if ((await page.locator('#play[aria-label="Play"]').count()) > 0) await page.click("#play");
  await viewer.waitForTick((await viewer.tick()) + 400);
  await page.click('#play[aria-label="Pause"]');
  await page.waitForSelector('#play[aria-label="Play"]');
  await page.focus("#view");
  await page.keyboard.press(",");
  await page.waitForSelector("#timeline.replaying");
  expect(await note()).toBe("");
  // Forces of another kind were not queried at that time.
  await page.selectOption("#coloring-kind", "force:wall_contact");
  expect(await note()).toContain("Forces are unknown at this time");
  await page.click("#replay-live");
  await expect.poll(note).toBe("");
  expect(viewer.consoleErrors).toEqual([]);
});

test("AnEmbeddedPageShowsOnlyViewAndPlayback", async () => {
  const viewer = await ViewerPage.open(browser, `${server.url}?session=thorax&embed`, { width: 720, height: 540 });
  const { page } = viewer;
  for (const id of ["header", "panel", "graphs"]) expect(await page.locator(`#${id}`).isVisible()).toBe(false);
  for (const id of ["play", "disclaimer", "open-full"]) expect(await page.locator(`#${id}`).isVisible()).toBe(true);
  expect(await page.getAttribute("#open-full", "href")).toBe("?session=thorax");
  expect(await viewer.violations()).toEqual([]);
  await viewer.saveScreenshot("embedded");
});
