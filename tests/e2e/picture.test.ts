import type { Browser } from "playwright-core";
import { afterAll, beforeAll, describe, expect, test } from "vitest";
import { endAll, startAll, ViewerPage } from "./browser";
import { canvasPicture, changedFraction, exactShare, modelBox } from "./pixels";
import type { Server } from "./server";

let server: Server;
let browser: Browser;
let viewer: ViewerPage;
const size = { width: 1400, height: 860 };

beforeAll(async () => {
  [browser, server] = await startAll("none");
  await server.phrenic("create", "thorax", "--id", "still", "--preset", "quiet");
  await server.phrenic("step", "still", "700");
  viewer = await ViewerPage.open(browser, `${server.url}?session=still`, size);
});

afterAll(() => endAll(browser, server));

const eye = () => viewer.page.evaluate(() => window.phrenic!.eye());

/** Waits until the camera has arrived and the picture is drawn in full resolution. */
async function arrived(): Promise<void> {
  await viewer.page.waitForFunction(() => !window.phrenic!.flying());
  await viewer.page.waitForTimeout(1200);
}

/** Presses a key on the canvas and waits for the flight. */
async function press(key: string): Promise<void> {
  await viewer.page.focus("#view");
  await viewer.page.keyboard.press(key);
  await arrived();
}

/** The layers of "thorax" that are shown at first, without the diaphragm. */
const othersThanDiaphragm = ["Ribs", "Sternum", "Costal cartilages", "Spine", "Intervertebral discs", "Lungs"].concat([
  "Heart",
  "Aorta",
  "Caval veins",
  "Windpipe and bronchi",
  "Gullet",
]);

describe("the picture", () => {
  test("ShowsTheModelOnSeventyPercentOfTheWindowAndClearOfPanels", async () => {
    await viewer.page.waitForTimeout(2500);
    const box = await modelBox(viewer);
    const share = Math.max(box.width, box.height) / Math.min(size.width, size.height);
    console.log(`the model spans ${(100 * share).toFixed(0)} % of the smaller window dimension`);
    expect(share).toBeGreaterThan(0.65);
    expect(share).toBeLessThan(0.8);
    const dock = (await viewer.page.locator("#dock").boundingBox())!;
    const views = (await viewer.page.locator("#views").boundingBox())!;
    expect(box.y + box.height).toBeLessThan(dock.y);
    expect(box.y).toBeGreaterThan(views.y + views.height);
    await viewer.saveScreenshot("picture-home");
  });

  test("HasExactlyTheColoursOfTheLegend", async () => {
    for (const layer of othersThanDiaphragm) await viewer.page.uncheck(`[aria-label="Show ${layer}"]`);
    await viewer.page.selectOption("#coloring-kind", "displacement");
    await press("1");
    expect(await exactShare(viewer)).toBeGreaterThan(0.7);
    await viewer.page.selectOption("#coloring-kind", "own");
    for (const layer of othersThanDiaphragm) await viewer.page.check(`[aria-label="Show ${layer}"]`);
  });

  test("DiffersByQuality", async () => {
    await viewer.page.selectOption("#quality", "plain");
    await viewer.page.waitForTimeout(2000);
    const plain = await canvasPicture(viewer);
    await viewer.page.selectOption("#quality", "full");
    await viewer.page.waitForTimeout(4000);
    expect(await changedFraction(browser, plain, await canvasPicture(viewer))).toBeGreaterThan(0.02);
    await viewer.saveScreenshot("picture-full");
    await viewer.page.selectOption("#quality", "automatic");
  });
});

describe("the named views", () => {
  test("AreReachedByKeysAndByTheList", async () => {
    await press("h");
    const seen = new Set<string>();
    for (const key of "1234567890") {
      await press(key);
      const cut = await viewer.page.inputValue("#cut");
      seen.add(`${cut} ${(await eye()).map((part) => part.toFixed(2)).join(" ")}`);
      expect(cut).toBe({ 8: "coronal", 9: "sagittal", 0: "transverse" }[key] ?? "none");
    }
    expect(seen.size, [...seen].join("\n")).toBe(10);
    await viewer.page.selectOption("#viewpoints", { label: "Coronal cut through the domes (8)" });
    await arrived();
    expect(await viewer.page.inputValue("#cut")).toBe("coronal");
    await viewer.saveScreenshot("picture-coronal");
    await press("h");
    expect(await viewer.page.inputValue("#cut")).toBe("none");
  });
});

describe("a structure", () => {
  test("IsNamedUnderTheRestingPointer", async () => {
    const box = (await viewer.page.locator("#view").boundingBox())!;
    await viewer.page.mouse.move(box.x + 0.65 * box.width, box.y + 0.6 * box.height);
    await viewer.page.waitForSelector("#structure-label:not([hidden])");
    expect(await viewer.page.textContent("#structure-label")).toContain("diaphragm");
    await viewer.page.mouse.move(box.x + 4, box.y + 0.5 * box.height);
    await viewer.page.waitForSelector("#structure-label", { state: "hidden" });
  });

  test("IsDefinedAfterAClick", async () => {
    const box = (await viewer.page.locator("#view").boundingBox())!;
    await viewer.page.mouse.click(box.x + 0.65 * box.width, box.y + 0.6 * box.height);
    await viewer.page.waitForSelector("#structure:not([hidden])");
    expect(await viewer.page.textContent("#structure h2")).toBe("Left dome of the diaphragm");
    expect(await viewer.page.textContent("#structure")).toContain("left phrenic nerve");
    expect(await viewer.violations()).toEqual([]);
  });

  test("IsFoundAndShownAloneUntilEscape", async () => {
    const { page } = viewer;
    const [before, whole] = [await eye(), await canvasPicture(viewer)];
    await page.focus("#view");
    await page.keyboard.press("/");
    await page.keyboard.type("rib 5 r");
    await page.waitForSelector('#find-results [role="option"]');
    expect(await viewer.violations()).toEqual([]);
    await page.keyboard.press("Enter");
    await arrived();
    expect(await page.textContent("#structure h2")).toBe("Right 5th rib");
    expect(await page.textContent("#structure .latin")).toBe("Costa V dextra");
    expect(await changedFraction(browser, whole, await canvasPicture(viewer))).toBeGreaterThan(0.1);
    expect(await eye()).not.toEqual(before);
    await viewer.saveScreenshot("picture-isolated");
    await press("Escape");
    expect(await page.textContent("#structure-alone")).toBe("Show alone");
    const after = await eye();
    after.forEach((part, k) => expect(part).toBeCloseTo(before[k], 1));
  });

  test("IsNamedInTheStudentView", async () => {
    const student = await ViewerPage.open(browser, `${server.url}?session=still&view=student`, size);
    await student.page.fill("#find-structure", "xiphoid");
    await student.page.press("#find-structure", "Enter");
    await student.page.waitForSelector("#structure:not([hidden])");
    expect(await student.page.textContent("#structure h2")).toBe("Xiphoid process");
    expect(await student.violations()).toEqual([]);
    expect(student.consoleErrors).toEqual([]);
    await student.close();
  });
});

test("ThereWereNoConsoleErrors", () => expect(viewer.consoleErrors).toEqual([]));
