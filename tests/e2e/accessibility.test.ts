import type { Browser } from "playwright-core";
import { afterAll, beforeAll, expect, test } from "vitest";
import { endAll, startAll, ViewerPage } from "./browser";
import type { Server } from "./server";

let server: Server;
let browser: Browser;
let viewer: ViewerPage;

beforeAll(async () => {
  [browser, server] = await startAll();
  viewer = await ViewerPage.open(browser, server.url);
});

afterAll(() => endAll(browser, server));

test("ThePageHasNoAxeViolations", async () => {
  await viewer.page.click('summary:has-text("Scene report")');
  expect(await viewer.violations()).toEqual([]);
});

test("TheControlDialogHasNoAxeViolations", async () => {
  await viewer.page.click("#control-badge");
  await viewer.page.fill("#control-name", "Anna");
  await viewer.page.click("#control-enter");
  await viewer.page.waitForSelector('[data-person="Anna"]');
  expect(await viewer.violations()).toEqual([]);
  await viewer.page.keyboard.press("Escape");
});

test("TheSessionChooserHasNoAxeViolations", async () => {
  await viewer.page.click("#session");
  await viewer.page.waitForSelector(".chooser li");
  expect(await viewer.violations()).toEqual([]);
  await viewer.page.keyboard.press("Escape");
});

test("ColoursAndDialogsHaveNoAxeViolations", async () => {
  const { page } = viewer;
  await page.selectOption("#coloring-kind", "largest");
  await page.waitForSelector("#coloring:not([hidden])");
  expect(await viewer.violations()).toEqual([]);
  await page.selectOption("#coloring-kind", "own");
  for (const dialog of ["#share-open", "#help-open"]) {
    await page.click(dialog);
    expect(await viewer.violations(), dialog).toEqual([]);
    await page.keyboard.press("Escape");
  }
});

test("ProjectorModeAndTwoViewsHaveNoAxeViolations", async () => {
  const { page } = viewer;
  await page.check("#projector");
  expect(await viewer.violations()).toEqual([]);
  await page.uncheck("#projector");
  await page.getByLabel("Compare with", { exact: true }).selectOption({ label: "COPD" });
  await page.waitForURL(/beside=/);
  await viewer.waitForPicture();
  await page.selectOption("#coloring-kind", "displacement");
  await page.check("#show-labels");
  expect(await viewer.violations()).toEqual([]);
  await page.goto(server.url);
  await viewer.waitForPicture();
});

test.each([
  ["a page zoomed to 200 %", 600, 360],
  ["a phone", 390, 780],
  ["a projector", 1280, 800],
])("TheHeaderFitsAndHasNoAxeViolationsOn %s", async (_, width, height) => {
  await viewer.page.setViewportSize({ width, height });
  for (const button of await viewer.page.locator("#header button:visible").all()) {
    const box = (await button.boundingBox())!;
    expect(box.x).toBeGreaterThanOrEqual(0);
    expect(box.x + box.width).toBeLessThanOrEqual(width);
  }
  expect(await viewer.violations()).toEqual([]);
  await viewer.page.setViewportSize({ width: 900, height: 620 });
});

test("TheNameOfTheSessionIsReadableAtEachWidth", async () => {
  const { page } = viewer;
  for (const lang of ["es", "en"]) {
    await page.goto(`${server.url}?session=thorax&view=expert&lang=${lang}`);
    await viewer.waitForPicture();
    for (const width of [761, 1000, 1100, 1101, 1200, 1260, 1261, 1280, 1440, 1481, 1601]) {
      await page.setViewportSize({ width, height: 620 });
      const [shown, whole] = await page.evaluate(() => {
        const name = document.querySelector("#session b")!;
        return [name.clientWidth, name.scrollWidth];
      });
      expect(shown, `${lang}, ${width} px: the name is cut off`).toBe(whole);
      expect(shown).toBeGreaterThan(100);
      expect(await page.evaluate(() => document.documentElement.scrollWidth)).toBeLessThanOrEqual(width);
    }
  }
  await page.setViewportSize({ width: 900, height: 620 });
});

test("TheHeaderFitsInProjectorMode", async () => {
  const { page } = viewer;
  await page.setViewportSize({ width: 1024, height: 768 });
  await page.check("#projector");
  await viewer.saveScreenshot("projector");
  for (const button of await page.locator("#header button:visible").all()) {
    const box = (await button.boundingBox())!;
    expect(box.x + box.width).toBeLessThanOrEqual(1024);
  }
  await page.uncheck("#projector");
  await page.setViewportSize({ width: 900, height: 620 });
});

test("TheKeyboardPlaysStepsRotatesAndMovesSliders", async () => {
  await viewer.page.focus("#view");
  await viewer.page.keyboard.press("Space");
  await viewer.page.waitForSelector('#play[aria-label="Play"]');
  const held = await viewer.tick();
  await viewer.page.keyboard.press(".");
  await viewer.waitForTick(held);
  const pictures = await viewer.page.evaluate(() => window.phrenic!.drawCount());
  await viewer.page.keyboard.press("ArrowLeft");
  await viewer.page.waitForFunction((before) => window.phrenic!.drawCount() > before, pictures);
  await viewer.page.focus("#parameter-ribMotion");
  await viewer.page.keyboard.press("ArrowRight");
  expect(Number(await viewer.value("ribMotion"))).toBeCloseTo(1.05, 6);
});
