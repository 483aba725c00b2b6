import type { Browser } from "playwright-core";
import { afterAll, beforeAll, expect, test } from "vitest";
import { endAll, startAll, ViewerPage } from "../browser";
import { canvasPicture, changedFraction } from "../pixels";
import type { Server } from "../server";

let server: Server;
let browser: Browser;
let viewer: ViewerPage;

beforeAll(async () => {
  [browser, server] = await startAll("none");
  await server.phrenic("create", "thorax", "--id", "lungs");
  await server.phrenic("step", "lungs", "1600"); // in inspiration
  viewer = await ViewerPage.open(browser, `${server.url}?session=lungs`, { width: 1440, height: 900 });
});

afterAll(() => endAll(browser, server));

test("TheInsideOfTheLungsIsColouredInACutAndFollowed", async () => {
  const { page } = viewer;
  await page.selectOption("#cut", "coronal");
  await page.waitForTimeout(1500);
  const plain = await canvasPicture(viewer);
  await page.selectOption("#coloring-kind", "tissue:ventilation");
  await page.waitForFunction(() => document.querySelector("#coloring-note")?.textContent === "", undefined, {
    timeout: 60_000,
  });
  await page.waitForTimeout(1500);
  expect(await page.textContent("#coloring")).toMatch(/Lungs: volume gained.*%/);
  const painted = await canvasPicture(viewer);
  expect(await changedFraction(browser, plain, painted)).toBeGreaterThan(0.1);
  await page.selectOption("#coloring-kind", "tissue:displacement");
  await page.waitForTimeout(1500);
  expect(await changedFraction(browser, painted, await canvasPicture(viewer))).toBeGreaterThan(0.1);

  // The card reads what the command line reads.
  await page.fill("#tissue-point", "-60, 0, 240");
  await page.click("#tissue-follow");
  const row = page.locator("#tissue tbody tr").first();
  await expect.poll(() => row.locator("td").first().textContent()).toMatch(/^\d/);
  const shown = (await row.locator("td").allTextContents()).slice(0, 3).map((text) => Number(text.replace("−", "-")));
  const line = await server.phrenic("watch", "lungs", "--at=-60,0,240", "--count", "1", "-o", "jsonl");
  const { probes, measures } = JSON.parse(line.trim().split("\n").at(-1)!).frame;
  const { dx = 0, dy = 0, dz = 0 } = probes.at(-1);
  expect(probes.at(-1).name).toBe("lung-right -60,0,240");
  expect(dz).toBeLessThan(-0.002);
  const [ventilation, strain] = measures.slice(-2).map(({ value }: { value: number }) => 100 * value);
  expect(shown[0]).toBeCloseTo(1000 * Math.hypot(dx, dy, dz), 0);
  expect(shown[1]).toBeCloseTo(ventilation, 0);
  expect(shown[2]).toBeCloseTo(strain, 0);

  // A click on the cut follows the tissue there.
  const box = (await page.locator("#view").boundingBox())!;
  for (const part of [0.5, 0.55, 0.6, 0.65]) {
    if ((await page.locator("#tissue tbody tr").count()) > 1) break;
    await page.mouse.click(box.x + part * box.width, box.y + 0.35 * box.height);
    await page.waitForTimeout(800);
  }
  expect(await page.locator("#tissue tbody tr").count()).toBe(2);
  await server.phrenic("step", "lungs", "100");
  await page.locator('.tile[data-graph="tissue-displacement"]').waitFor({ state: "attached" });
  await page.locator('.tile[data-graph="tissue-lung-right"]').waitFor({ state: "attached" });
  expect(viewer.consoleErrors).toEqual([]);
});
