import { readdir, readFile } from "node:fs/promises";
import { join } from "node:path";
import type { Browser, Download } from "playwright-core";
import { afterAll, beforeAll, describe, expect, test } from "vitest";
import { endAll, startAll, ViewerPage } from "./browser";
import { canvasPicture, changedFraction } from "./pixels";
import type { Server } from "./server";

let server: Server;
let browser: Browser;
let viewer: ViewerPage;

beforeAll(async () => {
  [browser, server] = await startAll("none");
  await server.phrenic("create", "pressure-lungs", "--id", "lungs");
  await server.phrenic("step", "lungs", "600");
  viewer = await ViewerPage.open(browser, `${server.url}?session=lungs`, { width: 1200, height: 720 });
});

afterAll(() => endAll(browser, server));

async function textOf(download: Download): Promise<string> {
  return readFile(await download.path(), "utf8");
}

/** Returns the fraction of pixels that `act` changes. */
async function changed(act: () => Promise<unknown>): Promise<number> {
  const before = await canvasPicture(viewer);
  await act();
  await viewer.page.waitForTimeout(1000);
  return changedFraction(browser, before, await canvasPicture(viewer));
}

describe("the graphs", () => {
  test("AreShownAndSaved", async () => {
    await server.phrenic("step", "lungs", "200");
    await viewer.waitForExactTick(800);
    const loop = viewer.page.locator('.tile[data-graph="loop"]');
    await loop.waitFor();
    await viewer.page.waitForTimeout(1500); // at rest the samples are read once a second
    const [csv] = await Promise.all([viewer.page.waitForEvent("download"), loop.getByText("CSV").click()]);
    const rows = (await textOf(csv)).trimEnd().split("\n");
    expect(csv.suggestedFilename()).toBe("lungs-loop.csv");
    expect(rows[0]).toBe("time [s],pleural pressure [Pa],lung volume [l]");
    // The last sample is at most an interval old.
    const last = Number(rows.at(-1)!.split(",")[0]);
    const now = await viewer.page.evaluate(() => window.phrenic!.time());
    expect(last).toBeLessThanOrEqual(now + 1e-9);
    expect(now - last).toBeLessThan(0.021);
    const [svg] = await Promise.all([viewer.page.waitForEvent("download"), loop.getByText("SVG").click()]);
    expect(await textOf(svg)).toContain("<polyline");
  });

  test("CanBeHeld", async () => {
    await viewer.page.click("#graphs-pause");
    expect(await viewer.page.textContent("#graphs-span")).toMatch(/^held, 0\.0 to 12\.0 s$/);
    await viewer.page.click("#graphs-pause");
    expect(await viewer.page.textContent("#graphs-span")).toBe("");
  });
});

describe("the picture", () => {
  test("ShowsFieldsCutsAndGhosts", async () => {
    expect(await changed(() => viewer.page.selectOption("#coloring-kind", "displacement"))).toBeGreaterThan(0.02);
    expect(await viewer.page.textContent("#coloring")).toMatch(/Displacement.*mm/);
    const fitted = await viewer.page.inputValue("#coloring-top");
    await viewer.page.fill("#coloring-top", "1");
    expect(await changed(() => viewer.page.press("#coloring-top", "Enter"))).toBeGreaterThan(0.004);
    await viewer.page.click("#coloring-fit");
    expect(await viewer.page.inputValue("#coloring-top")).toBe(fitted);
    expect(await changed(() => viewer.page.selectOption("#ghost", "rest"))).toBeGreaterThan(0.002);
    expect(await changed(() => viewer.page.selectOption("#cut", "coronal"))).toBeGreaterThan(0.02);
    await viewer.saveScreenshot("tools");
    await viewer.page.selectOption("#cut", "none");
    await viewer.page.selectOption("#ghost", "none");
  });

  test("PicksAndTracksAVertex", async () => {
    const box = (await viewer.page.locator("#view").boundingBox())!;
    await viewer.page.mouse.click(box.x + 0.62 * box.width, box.y + 0.5 * box.height);
    await viewer.page.waitForSelector("#picked:not([hidden])");
    expect(await viewer.page.textContent("#picked h2")).toMatch(/^Vertex \d+ of (diaphragm|balloon)$/);
    await viewer.page.click("#track");
    await viewer.page.click("#parameter-applyMuscles");
    await server.phrenic("step", "lungs", "20");
    await viewer.page.waitForSelector('.tile[data-graph="tracked"]');
  });

  test("HasNoAxeViolationssCardsAndGraphs", async () => {
    expect(await viewer.violations()).toEqual([]);
  });
});

test("TheKeyboardUndoesAChange", async () => {
  await viewer.type("breathForce", 2);
  await expect.poll(() => viewer.page.isEnabled("#undo")).toBe(true);
  await viewer.page.focus("#view");
  await viewer.page.keyboard.press("Control+z");
  await viewer.page.waitForFunction(
    () => document.querySelector<HTMLInputElement>("#parameter-breathForce-entry")?.value === "1",
  );
});

test("APermalinkReproducesTheVertices", async () => {
  await server.phrenic("create", "cube-tensegrity", "--id", "cube", "--set", "breath_force=1.5");
  await server.phrenic("step", "cube", "120");
  const cube = await ViewerPage.open(browser, `${server.url}?session=cube`);
  await cube.waitForExactTick(120);
  await cube.page.click("#share-open");
  const link = await cube.page.inputValue("#share-permalink");
  const again = await ViewerPage.open(browser, link);
  await again.waitForExactTick(120);
  expect(new URL(again.page.url()).search).not.toBe("?session=cube");
  expect((await again.sample("cube", 1)).points).toEqual((await cube.sample("cube", 1)).points);
  await again.close();

  // The dialog is still open.
  await cube.page.click("#share-compare");
  await cube.page.waitForSelector("#second-view canvas");
  await cube.page.waitForSelector('.differences:text-is("Same parameters")');
  await cube.type("breathForce", 3);
  await cube.page.waitForSelector('.differences:text-is("Breath force 1.5 instead of 3")');
  await cube.saveScreenshot("second-view");
  expect([...cube.consoleErrors, ...again.consoleErrors]).toEqual([]);
  await cube.close();
});

test("AStudyRunsAndIsShown", async () => {
  const page = await ViewerPage.open(browser, `${server.url}?session=cube`);
  await page.page.click('summary:has-text("Studies")');
  await page.page.selectOption("#study-kind", "cost");
  await page.page.click("#study-start");
  await page.page.click('.study button:text-is("Open")', { timeout: 60_000 });
  await page.page.waitForSelector(".study-view[open]");
  await expect.poll(() => page.page.locator(".study-view h1").textContent()).toMatch(/^Cost: /);
  expect(await page.page.locator(".study-view svg.plot").count()).toBeGreaterThan(0);
  expect(await page.violations()).toEqual([]);
  await page.saveScreenshot("study");
  expect(page.consoleErrors).toEqual([]);
  await page.close();
});

test("ThePageLoadsQuickly", async () => {
  const folder = join(import.meta.dirname, "../../web/dist/assets");
  const scripts = (await readdir(folder)).filter((name) => name.endsWith(".js"));
  let bytes = 0;
  const sent = new Map<string, number>();
  for (const name of scripts) {
    const answer = await fetch(`${server.url}assets/${name}`, { headers: { "Accept-Encoding": "br" } });
    expect(answer.headers.get("Content-Encoding")).toBe("br");
    sent.set(`/assets/${name}`, Number(answer.headers.get("Content-Length")));
    bytes += sent.get(`/assets/${name}`)!;
    await answer.body?.cancel();
  }
  console.log(`all scripts, as they are sent: ${(bytes / 1000).toFixed(0)} kB`);
  expect(bytes).toBeLessThan(450_000);
  for (const name of (await readdir(folder)).filter((each) => each.endsWith(".wasm"))) {
    const answer = await fetch(`${server.url}assets/${name}`, { headers: { "Accept-Encoding": "br" } });
    expect(answer.headers.get("Content-Type")).toBe("application/wasm");
    console.log(`${name}, as it is sent: ${answer.headers.get("Content-Length")} bytes`);
    expect(Number(answer.headers.get("Content-Length"))).toBeLessThan(30_000);
    await answer.body?.cancel();
  }
  // Scripts and requests before the first drawing are bounded. Times are only printed, since they depend on the
  // machine.
  const times: number[] = [];
  for (let i = 0; i < 5; i++) {
    const context = await browser.newContext({ viewport: { width: 900, height: 620 } });
    const page = await context.newPage();
    const asked: string[] = [];
    page.on("request", (request) => asked.push(new URL(request.url()).pathname));
    await page.goto(`${server.url}?session=lungs`);
    await page.waitForFunction(() => (window.phrenic?.firstDrawTime() ?? -1) >= 0);
    times.push(Math.round(await page.evaluate(() => window.phrenic!.firstDrawTime())));
    expect(asked.length, asked.join(" ")).toBeLessThanOrEqual(16);
    const first = asked.reduce((sum, path) => sum + (sent.get(path) ?? 0), 0);
    expect(first).toBeGreaterThan(100_000);
    expect(first).toBeLessThan(325_000);
    await context.close();
  }
  console.log(`first picture after the address, five times [ms]: ${times.join(" ")}`);
});

test("ThereWereNoConsoleErrors", () => {
  expect(viewer.consoleErrors).toEqual([]);
});
