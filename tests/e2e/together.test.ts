import type { Browser } from "playwright-core";
import { afterAll, beforeAll, expect, test } from "vitest";
import { launchBrowser, ViewerPage } from "./browser";
import { Server } from "./server";

let server: Server;
let browsers: Browser[];
let here: ViewerPage;
let there: ViewerPage;

beforeAll(async () => {
  server = await Server.start();
  browsers = [await launchBrowser(), await launchBrowser()];
  here = await ViewerPage.open(browsers[0], server.url);
  there = await ViewerPage.open(browsers[1], here.page.url());
});

afterAll(async () => {
  for (const browser of browsers ?? []) await browser.close();
  await server?.end();
});

test("TwoBrowsersPlayOneSession", async () => {
  const [a, b] = await Promise.all([here.tick(), there.tick()]);
  await Promise.all([here.waitForTick(a), there.waitForTick(b)]);
  await here.page.waitForFunction(() => Number(document.querySelector("#status-viewers")?.textContent) === 2);
});

test("TwoBrowsersSeeTheSameVerticesAtTheSameTick", async () => {
  await here.page.click('#play[aria-label="Pause"]');
  await there.page.waitForSelector('#play[aria-label="Play"]');
  const held = await server.restingTick();
  await Promise.all([here.waitForExactTick(held), there.waitForExactTick(held)]);
  const [a, b] = await Promise.all([here.sample("diaphragm", 50), there.sample("diaphragm", 50)]);
  expect([a.tick, b.tick]).toEqual([held, held]);
  const off = a.points.flatMap((point, i) => point.map((value, axis) => Math.abs(value - b.points[i][axis])));
  expect(Math.max(...off)).toBeLessThanOrEqual(2e-3); // each is within its error bound, which grows to 1 mm on a busy machine
});

test("ASliderMovesInBothBrowsers", async () => {
  await here.page.focus("#parameter-breathLength");
  for (let i = 0; i < 5; i++) await here.page.keyboard.press("ArrowRight");
  const set = await here.value("breathLength");
  expect(Number(set)).toBeCloseTo(4.5, 6);
  await there.page.waitForFunction(
    (value) => document.querySelector<HTMLInputElement>("#parameter-breathLength")?.value === value,
    set,
  );
  await there.page.uncheck("#parameter-applyMuscles");
  await here.page.waitForFunction(() => !document.querySelector<HTMLInputElement>("#parameter-applyMuscles")?.checked);
  await there.page.check("#parameter-applyMuscles");
});

test("ALostServerIsShownAndTheSessionIsRestored", async () => {
  await here.page.click("#play");
  await server.phrenic("set", "thorax", "breath_force=1.5");
  await here.waitForTick(await here.tick());
  const { tick } = await server.session();
  await server.kill();
  await here.waitForLink("lost");
  expect(await here.page.innerText("#connection")).toContain("retrying");
  expect(await here.page.isVisible("#banner-lost")).toBe(true);
  expect(await here.violations()).toEqual([]);
  await here.saveScreenshot("lost");
  await server.restart();
  await here.waitForLink("live");
  await there.waitForLink("live");
  expect(await here.page.isVisible("#banner-lost")).toBe(false);
  await here.waitForTick(await here.tick());
  const session = await server.session();
  expect(session.parameters.breath_force).toBe(1.5);
  expect(session.state).toBe("SESSION_STATE_PLAYING");
  expect(Number(session.tick)).toBeGreaterThan(Number(tick) - 1 / session.parameters.time_step);
});

test("OnlyTheLossCausedConsoleErrors", () => {
  const expected = /net::ERR_/;
  expect([...here.consoleErrors, ...there.consoleErrors].filter((text) => !expected.test(text))).toEqual([]);
});
