import { readFile, writeFile } from "node:fs/promises";
import { join } from "node:path";
import type { Browser } from "playwright-core";
import { afterAll, beforeAll, describe, expect, test } from "vitest";
import { endAll, startAll, ViewerPage } from "./browser";
import { outFolder, type Server } from "./server";

let server: Server;
let browser: Browser;

beforeAll(async () => {
  [browser, server] = await startAll();
});

afterAll(() => endAll(browser, server));

describe("a session made in the browser", () => {
  for (const [scene, body] of [
    ["cube-springs", "cube"],
    ["cube-tensegrity", "cube"],
    ["sheet-2d", "sheet"],
  ]) {
    test(`Of${scene}Moves`, async () => {
      const viewer = await ViewerPage.open(browser, `${server.url}?session=thorax`);
      await viewer.page.click("#session");
      const title = await titleOf(viewer, scene);
      await viewer.page.click(`button[aria-label="Start: ${title}"]`);
      await viewer.page.waitForURL((url) => url.search.startsWith(`?session=${scene}`));
      await viewer.waitForPicture();
      const before = await viewer.sample(body, 1);
      await viewer.waitForTick(before.tick + 20);
      await viewer.page.waitForTimeout(1000);
      expect((await viewer.sample(body, 1)).points).not.toEqual(before.points);
      await viewer.page.check("#show-links");
      await viewer.saveScreenshot(scene);
      expect(viewer.consoleErrors).toEqual([]);
      await viewer.close();
    });
  }

  /** Returns the title of a scene in the dialog. */
  async function titleOf(viewer: ViewerPage, scene: string): Promise<string> {
    const row = viewer.page.locator(`.chooser li[data-scene="${scene}"] b`);
    await row.waitFor();
    return (await row.textContent()) ?? "";
  }
});

test("AFittedPersonOfNoCatalogueHasItsPresetsAndWalls", async () => {
  const shipped = await readFile(join(import.meta.dirname, "../../server/scenes/person-2.textproto"), "utf8");
  const file = join(outFolder, "someone.textproto");
  await writeFile(file, shipped.replace(/"person-2"/, '"someone"'));
  await server.phrenic("create", file, "--id", "someone", "--play");
  const viewer = await ViewerPage.open(browser, `${server.url}?session=someone`);
  await viewer.waitForPicture();
  await viewer.page.click('.preset-list button:has-text("Walls alone")');
  const piston = viewer.page.locator("#parameter-lungPistonRight");
  await expect.poll(() => piston.inputValue()).toBe("0");
  await viewer.page.click('.preset-list button:has-text("Fitted")');
  await expect.poll(async () => Number(await piston.inputValue())).toBeGreaterThan(0);
  await viewer.saveScreenshot("person");
  expect(viewer.consoleErrors).toEqual([]);
  await viewer.close();
});

test("ADivergedSessionShowsARemedyThatHelps", async () => {
  const viewer = await ViewerPage.open(browser, server.url);
  await viewer.page.click("#session");
  const before = viewer.page.url();
  await viewer.page.click('.chooser li[data-scene="cube-springs"] button');
  await viewer.page.waitForURL((url) => url.href !== before);
  await viewer.waitForPicture();
  await viewer.type("elasticity", 100);
  await viewer.type("timeStep", 0.1);
  await viewer.page.waitForSelector("#banner-diverged:not([hidden])", { timeout: 60_000 });
  expect(await viewer.page.textContent("#banner-diverged")).toMatch(/diverged at .* s, at vertex \d+ of cube/);
  await viewer.saveScreenshot("diverged");
  await viewer.page.click('button:has-text("Restart with a stable time step")');
  await viewer.page.waitForSelector("#banner-diverged", { state: "hidden" });
  await viewer.waitForTick(10);
  expect(await viewer.page.isHidden("#banner-diverged")).toBe(true);
  await viewer.close();
});

test("AMissingSessionOffersOthers", async () => {
  const context = await browser.newContext();
  const page = await context.newPage();
  await page.goto(`${server.url}?session=nobody`);
  await page.waitForSelector('#connection[data-state="lost"]');
  expect(await page.textContent("#banner-lost")).toContain("nobody");
  await page.click('button:has-text("Choose a session")');
  await page.click('.chooser button:has-text("Open")');
  await page.waitForSelector('#connection[data-state="live"]');
  await context.close();
});

test("OnAPhoneTheViewComesFirst", async () => {
  const viewer = await ViewerPage.open(browser, server.url, { width: 390, height: 780 });
  expect(await viewer.page.isVisible("#panel")).toBe(false);
  await viewer.saveScreenshot("phone");
  await viewer.page.click("#panel-toggle");
  expect(await viewer.page.isVisible("#parameter-breathForce")).toBe(true);
  await viewer.saveScreenshot("phone-panel");
  const wider = await viewer.page.evaluate(() => document.documentElement.scrollWidth > innerWidth);
  expect(wider).toBe(false);
  await viewer.close();
});
