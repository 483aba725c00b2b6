import { readFile } from "node:fs/promises";
import type { Browser } from "playwright-core";
import { afterAll, beforeAll, describe, expect, test } from "vitest";
import { endAll, startAll, ViewerPage } from "./browser";
import type { Server } from "./server";

let browser: Browser;
let server: Server;
let viewer: ViewerPage;

beforeAll(async () => {
  [browser, server] = await startAll("thorax");
  viewer = await ViewerPage.open(browser, server.url, { width: 1280, height: 800 });
}, 120_000);

afterAll(() => endAll(browser, server));

/** Returns the values that the panel lists: the numbers of each measurement. */
async function listed(): Promise<number[][]> {
  const texts = await viewer.page.locator(".measured td.reading").allTextContents();
  return texts.map((text) => [...text.matchAll(/[\d.]+/g)].map(([word]) => Number(word)));
}

describe("measuring", () => {
  test("FollowsTheMotionOfPickedPointsAndStructures", async () => {
    const { page } = viewer;
    const box = (await page.locator("#view").boundingBox())!;
    const click = (x: number, y: number) => page.mouse.click(box.x + x * box.width, box.y + y * box.height);
    await page.focus("#view");
    await page.keyboard.press("m");
    await click(0.42, 0.32);
    await click(0.6, 0.55);
    await page.click("#measure-angle");
    await click(0.42, 0.5);
    await click(0.5, 0.6);
    await page.click("#view", { position: { x: 0.58 * box.width, y: 0.5 * box.height } });
    await page.fill("#find-structure", "right lung");
    await page.press("#find-structure", "Enter");
    await page.click("#structure-measure");
    await expect.poll(async () => (await listed()).map(({ length }) => length)).toEqual([1, 1, 2]);
    const before = await listed();
    const [[millimetres], [degrees], [area, volume]] = before;
    expect(millimetres).toBeGreaterThan(10);
    expect(degrees).toBeLessThan(180);
    // The sphere has the least surface of all bodies of this volume: A^3 >= 36 pi V^2.
    expect(area ** 3).toBeGreaterThan(36 * Math.PI * volume ** 2);
    expect(volume).toBeGreaterThan(800);
    await expect.poll(async () => Math.abs((await listed())[2][1] - volume), { timeout: 20_000 }).toBeGreaterThan(20);
    expect(await page.locator(".measures text").allTextContents()).toContainEqual(
      expect.stringMatching(/cm², \d+ ml$/),
    );
    expect(await viewer.violations()).toEqual([]);
    await viewer.saveScreenshot("measuring");
  });

  test("IsPlottedAndSavedWithThePictureAndAsCsv", async () => {
    const { page } = viewer;
    await page.waitForSelector('.tile[data-graph="measured-volume"]');
    const saved = page.waitForEvent("download");
    await page.click('.tile[data-graph="measured-volume"] button:text-is("CSV")');
    const [head, row] = (await readFile(await (await saved).path(), "utf8")).split("\n");
    expect(head).toBe("time [s],Right lung [ml]");
    expect(row).toMatch(/^[\d.]+,\d{3,4}/);
    await page.focus("#view");
    const picture = page.waitForEvent("download");
    await page.keyboard.press("p");
    expect((await readFile(await (await picture).path())).length).toBeGreaterThan(10_000);
  });

  test("WorksByKeyboardAndEndsWithEscape", async () => {
    const { page } = viewer;
    await page.focus("#view");
    await page.keyboard.press("Escape"); // the tool
    await page.keyboard.press("Escape"); // the structure that is shown alone
    await page.keyboard.press("Escape"); // the measurements
    await expect.poll(listed).toEqual([]);
    await page.waitForFunction(() => !window.phrenic!.flying());
    await page.keyboard.press("m");
    await page.keyboard.press("Shift+ArrowUp");
    await page.keyboard.press("Enter");
    for (let i = 0; i < 4; i++) await page.keyboard.press("Shift+ArrowDown");
    expect(await page.textContent("#measure-hint")).toContain("point 2 of 2");
    await page.keyboard.press("Enter");
    await expect.poll(listed).toHaveLength(1);
    await page.click('.measured button[aria-label^="Remove the measurement"]');
    expect(await listed()).toEqual([]);
    await page.keyboard.press("Escape");
    expect(await page.isHidden("#measure-hint")).toBe(true);
    expect(viewer.consoleErrors).toEqual([]);
  });
});

describe("names beside the scene", () => {
  const count = () => viewer.page.locator(".name-label").count();
  /**
   * Returns where the names and their leaders are, all at one time: each picture of a moving camera places them anew.
   */
  const placed = async () => {
    const read = () => {
      const boxes = [...document.querySelectorAll(".name-label")].map((each) => each.getBoundingClientRect());
      const leaders = document.querySelectorAll(".names polyline").length;
      return boxes.length > 15 && leaders > 0 && { boxes: boxes.map((each) => each.toJSON() as DOMRect), leaders };
    };
    return (await viewer.page.waitForFunction(read)).jsonValue() as Promise<Exclude<ReturnType<typeof read>, false>>;
  };

  test("NeitherOverlapNorLeaveTheStage", async () => {
    const { page } = viewer;
    await page.focus("#view");
    await page.keyboard.press("n");
    expect(await page.isChecked("#show-labels")).toBe(true);
    const stage = (await page.locator("#view").boundingBox())!;
    const { boxes, leaders } = await placed();
    boxes.forEach((a, i) => {
      expect(a.x).toBeGreaterThanOrEqual(stage.x);
      expect(a.x + a.width).toBeLessThanOrEqual(stage.x + stage.width);
      for (const b of boxes.slice(i + 1))
        expect(Math.abs(a.x - b.x) >= a.width || Math.abs(a.y - b.y) > a.height - 0.01).toBe(true);
    });
    expect(leaders).toBe(boxes.length);
    expect(await viewer.violations()).toEqual([]);
    await viewer.saveScreenshot("names");
  });

  test("AreHiddenWhileTheCameraMovesAndPlacedAgain", async () => {
    const { page } = viewer;
    await page.focus("#view");
    await page.keyboard.press("ArrowLeft");
    await page.waitForFunction(() => document.querySelector<HTMLElement>(".name-labels")!.hidden);
    await expect.poll(count).toBeGreaterThan(15);
  });

  test("ChooseTheirStructureByKeyboard", async () => {
    const { page } = viewer;
    await page.locator('.name-label[tabindex="0"]').focus();
    await page.keyboard.press("ArrowDown");
    const name = await page.evaluate(() => document.activeElement?.firstElementChild?.textContent);
    await page.keyboard.press("Enter");
    await page.waitForSelector("#structure:not([hidden])");
    expect(await page.textContent("#structure h2")).toBe(name);
    await page.uncheck("#show-labels");
    await expect.poll(count).toBe(0);
    expect(viewer.consoleErrors).toEqual([]);
  });
});
