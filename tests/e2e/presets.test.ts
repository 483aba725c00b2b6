import type { Browser } from "playwright-core";
import { afterAll, beforeAll, expect, test } from "vitest";
import { endAll, startAll, ViewerPage } from "./browser";
import type { Server } from "./server";

let server: Server;
let browser: Browser;
let viewer: ViewerPage;

beforeAll(async () => {
  [browser, server] = await startAll("thorax");
  viewer = await ViewerPage.open(browser, server.url);
});

afterAll(() => endAll(browser, server));

const fold = (name: string) => viewer.page.locator(`.preset-group:has(summary:text-is("${name}"))`);

test("ThePresetsStandInGroupsAndTheFirstIsOpen", async () => {
  expect(await viewer.page.locator(".preset-group summary").allTextContents()).toEqual([
    "Breathing patterns",
    "Manoeuvres",
    "Nerve and muscle",
    "Lungs and pleura",
    "Chest wall and abdomen",
    "Support",
  ]);
  expect(await viewer.page.locator("#presets button").count()).toBe(33);
  expect(await viewer.page.locator("#presets button:visible").count()).toBe(9);
  expect(await viewer.violations()).toEqual([]);
});

test("TheKeyboardUnfoldsAGroupAndAppliesAPreset", async () => {
  const { page } = viewer;
  await fold("Lungs and pleura").locator("summary").focus();
  await page.keyboard.press("Enter");
  await page.keyboard.press("Tab");
  expect(await page.evaluate(() => document.activeElement!.textContent)).toBe("COPD");
  await page.keyboard.press("Enter");
  await page.waitForSelector('#presets button[aria-pressed="true"]:text-is("COPD")');
  expect(await page.textContent(".preset-description")).toContain("air stays behind");
  // A button whose colour still changes has less contrast.
  await page.waitForFunction(() => document.getAnimations().every((each) => !(each instanceof CSSTransition)));
  expect(await viewer.violations()).toEqual([]);
});

test("AnotherViewersPresetUnfoldsItsGroup", async () => {
  await server.phrenic("set", await onlySession(), "--preset", "palsy-right");
  await viewer.page.waitForSelector('#presets button[aria-pressed="true"]:text-is("Right palsy"):visible');
  expect(await fold("Nerve and muscle").getAttribute("open")).not.toBeNull();
});

test("ABodyThatTheSceneHidesIsStreamedOnceItIsShown", async () => {
  const { page } = viewer;
  await page.click('#play[aria-label="Pause"]');
  await page.waitForSelector('#play[aria-label="Play"]');
  expect(await page.isChecked('[aria-label="Show Mechanics"]')).toBe(false);
  const before = (await viewer.sample("chest-wall")).points;
  await page.check('[aria-label="Show Mechanics"]');
  await expect.poll(async () => (await viewer.sample("chest-wall")).points, { timeout: 10_000 }).not.toEqual(before);
  expect(viewer.consoleErrors).toEqual([]);
});

async function onlySession(): Promise<string> {
  return JSON.parse(await server.phrenic("sessions", "-o", "json")).sessions[0].id;
}
