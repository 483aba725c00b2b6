import axe from "axe-core";
import { statSync } from "node:fs";
import { join } from "node:path";
import { pathToFileURL } from "node:url";
import type { Browser, Page } from "playwright-core";
import { afterAll, beforeAll, expect, test } from "vitest";
import { endAll, isComplaint, startAll, ViewerPage } from "./browser";
import { changedFraction } from "./pixels";
import { outFolder, type Server } from "./server";

let server: Server;
let browser: Browser;
const path = join(outFolder, "breath.html");

beforeAll(async () => {
  [browser, server] = await startAll();
  // A breath that moves far needs the most bytes; a shorter one is recorded sooner.
  await server.phrenic("set", "thorax", "--preset", "deep");
  await server.phrenic("set", "thorax", "breath_length=3");
  const viewer = await ViewerPage.open(browser, server.url);
  await viewer.page.click("#share-open");
  expect(await viewer.violations()).toEqual([]);
  const [file] = await Promise.all([
    viewer.page.waitForEvent("download", { timeout: 100_000 }),
    viewer.page.click("#take-home"),
  ]);
  expect(file.suggestedFilename()).toBe("thorax.html");
  await file.saveAs(path);
  await viewer.close();
});

afterAll(() => endAll(browser, server));

/** Opens the file without a network. */
async function open() {
  const context = await browser.newContext({
    viewport: { width: 1280, height: 800 },
    offline: true,
    colorScheme: "dark",
  });
  const page = await context.newPage();
  const [complaints, requests]: string[][] = [[], []];
  page.on("console", (message) => isComplaint(message) && complaints.push(message.text()));
  page.on("pageerror", (error) => complaints.push(String(error)));
  page.on("request", (request) => requests.push(request.url()));
  const url = pathToFileURL(path).href;
  await page.goto(url);
  await page.waitForSelector("#loading", { state: "hidden", timeout: 30_000 });
  const foreign = () => requests.filter((each) => each !== url && !/^(data|blob):/.test(each));
  return { page, complaints, foreign };
}

/** Returns the fraction of the picture's pixels that `act` changes. */
async function changed(page: Page, act: () => Promise<unknown>): Promise<number> {
  const picture = async () => (await page.locator("#view").screenshot()).toString("base64");
  await page.waitForTimeout(700);
  const before = await picture();
  await act();
  await page.waitForTimeout(700);
  return changedFraction(browser, before, await picture());
}

async function violations(page: Page): Promise<string[]> {
  await page.evaluate(axe.source);
  return page.evaluate(async () => {
    const { violations } = await (window as unknown as { axe: typeof axe }).axe.run();
    return violations.map(({ id, nodes }) => `${id}: ${nodes.map((node) => node.target).join(", ")}`);
  });
}

test("ABreathTakenHomePlaysWithoutANetwork", async () => {
  expect(statSync(path).size).toBeLessThan(5_000_000);
  const { page, complaints, foreign } = await open();
  const time = () => page.textContent("#timeline output");
  const before = await time();
  await expect.poll(time).not.toBe(before);
  await page.click("#play");
  expect(await page.title()).toMatch(/– Phrenic$/);
  expect(await page.textContent("#disclaimer")).toBe("Research and teaching; not for clinical use");
  expect(await page.textContent('.tile:has-text("Lung volume") h3 b')).toMatch(/^\d/);
  expect(await page.locator(".tile canvas").count()).toBeGreaterThan(4);
  expect(await changed(page, () => page.fill("#scrub", "2"))).toBeGreaterThan(0.002);
  expect(await changed(page, () => page.press("#view", "ArrowLeft"))).toBeGreaterThan(0.01);
  expect(await changed(page, () => page.uncheck('.layer-name:has-text("Ribs") input'))).toBeGreaterThan(0.01);
  expect(await violations(page)).toEqual([]);
  await page.screenshot({ path: join(outFolder, "offline-dark.png") });
  await page.emulateMedia({ colorScheme: "light" });
  expect(await violations(page)).toEqual([]);
  await page.screenshot({ path: join(outFolder, "offline-light.png") });
  await page.setViewportSize({ width: 360, height: 740 });
  await page.waitForTimeout(800);
  await page.screenshot({ path: join(outFolder, "offline-phone.png"), fullPage: true });
  expect(complaints).toEqual([]);
  expect(foreign()).toEqual([]);
  await page.context().close();
});
