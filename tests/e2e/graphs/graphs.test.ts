import { readFile } from "node:fs/promises";
import type { Browser } from "playwright-core";
import { afterAll, beforeAll, expect, test } from "vitest";
import { endAll, startAll, ViewerPage } from "../browser";
import type { Server } from "../server";

let server: Server;
let browser: Browser;
let viewer: ViewerPage;

beforeAll(async () => {
  [browser, server] = await startAll();
  viewer = await ViewerPage.open(browser, `${server.url}?session=thorax&view=expert`, { width: 1440, height: 900 });
});

afterAll(() => endAll(browser, server));

/** Returns the times of a saved graph [s]. */
async function savedTimes(graph: string): Promise<number[]> {
  const [file] = await Promise.all([
    viewer.page.waitForEvent("download"),
    viewer.page.click(`#graphs [data-graph="${graph}"] button:has-text("CSV")`),
  ]);
  const [, ...rows] = (await readFile(await file.path(), "utf8")).trim().split("\n");
  return rows.map((row) => Number(row.split(",")[0]));
}

test("SavedCurvesHaveNoGapHoweverFewPicturesAreDrawn", async () => {
  const { page } = viewer;
  const drawn = () => page.evaluate(() => window.phrenic!.drawCount());
  // Four breaths at the speed of this machine; the page draws a few pictures a second meanwhile.
  await page.waitForFunction(
    () => /time\s*1\d/.test(document.querySelector("#readout-slot")?.textContent ?? ""),
    null,
    {
      timeout: 120_000,
    },
  );
  const times = await savedTimes("measure lung volume");
  const gaps = times.slice(1).map((time, i) => time - times[i]);
  expect(times.length).toBeGreaterThan(100);
  // Equal to within a time step, which is not a part of the interval here.
  expect(Math.min(...gaps)).toBeGreaterThan(0.0185);
  expect(Math.max(...gaps)).toBeLessThan(0.0215);
  console.log(`${times.length} samples in ${await drawn()} drawings`);
});

test("TheCampbellDiagramHasItsCurvesAndWork", async () => {
  const { page } = viewer;
  const note = page.locator('#graphs [data-graph="campbell"] .note');
  await note.scrollIntoViewIfNeeded();
  expect(await note.textContent()).toMatch(/Work of a breath: 0\.\d+ J against recoil, 0\.\d+ J against resistance/);
  expect(await page.locator('#graphs [data-graph="measure lung volume"] .note').textContent()).toMatch(
    /0\.4 to 0\.7 l/,
  );
  expect(await viewer.violations()).toEqual([]);
  await viewer.saveScreenshot("campbell");
  expect(viewer.consoleErrors).toEqual([]);
});
