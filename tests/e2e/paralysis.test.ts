import type { Browser } from "playwright-core";
import { afterAll, beforeAll, expect, test } from "vitest";
import { launchBrowser, ViewerPage } from "./browser";
import { Server } from "./server";

let server: Server;
let browser: Browser;

beforeAll(async () => {
  browser = await launchBrowser();
  server = await Server.start();
});

afterAll(async () => {
  await browser?.close();
  await server?.kill();
});

test("FromTheAddressToAParalysedHemidiaphragmBesideAHealthyOneInUnderAMinute", async () => {
  const start = Date.now();
  const viewer = await ViewerPage.open(browser, server.url, { width: 1200, height: 720 });
  const { page } = viewer;
  const list = page.getByLabel("Compare with", { exact: true });
  expect(await list.isVisible()).toBe(true);
  await list.selectOption({ label: "Paralysis right" });
  await page.waitForURL(/beside=/);
  await viewer.waitForPicture();
  await page.locator("#beside").getByText("Paralysis right").waitFor();
  const ways = await page.locator(".pane-head b").allTextContents();
  expect(ways.toSorted()).toEqual(["Paralysis right", "Quiet"]);
  expect(Date.now() - start).toBeLessThan(60_000);
  expect(await page.textContent(".differences")).toBe("Right muscle 0 instead of 1");
  // The list is now of the second picture.
  await page.getByLabel("Compare with", { exact: true }).selectOption({ label: "Paralysis left" });
  await page.locator("#beside").getByText("Paralysis left").waitFor();
  expect(viewer.complaints).toEqual([]);
  await viewer.leave("paralysis");
});
