import { readFile } from "node:fs/promises";
import { join } from "node:path";
import type { Browser } from "playwright-core";
import { afterAll, beforeAll, describe, expect, test } from "vitest";
import { endAll, startAll, ViewerPage } from "./browser";
import { canvasPicture, changedFraction } from "./pixels";
import { outFolder, type Server } from "./server";

let server: Server;
let browser: Browser;
let viewer: ViewerPage;

beforeAll(async () => {
  [browser, server] = await startAll();
});

afterAll(() => endAll(browser, server));

/**
 * Returns the current state of a session as a file of `phrenic export`, with its nodes raised by `up(x)` millimetres.
 */
async function exported(session: string, body: string, up: (x: number) => number): Promise<Buffer> {
  const path = join(outFolder, `${session}.msh`);
  await server.phrenic("export", session, path, "--seconds", "0", "--body", body);
  const [head, rest] = (await readFile(path, "utf8")).split("$Nodes\n");
  const [nodes, tail] = rest.split("$EndNodes");
  const moved = nodes.split("\n").map((line) => {
    const [id, x, y, z] = line.split(" ");
    return z === undefined ? line : [id, x, y, Number(z) + up(Number(x))].join(" ");
  });
  return Buffer.from([head, "$Nodes\n", moved.join("\n"), "$EndNodes", tail].join(""));
}

const choose = (name: string, buffer: Buffer) =>
  viewer.page.setInputFiles("#compare-file", { name, mimeType: "text/plain", buffer });
const measure = async (name: string) => Number(await viewer.page.textContent(`[data-measure="${name}"]`));
const found = () => viewer.page.waitForSelector("#comparison .result:not([hidden])", { timeout: 60_000 });

describe("a cube compared with itself, 3 mm higher", () => {
  beforeAll(async () => {
    await server.phrenic("create", "cube-tensegrity", "--id", "cube");
    viewer = await ViewerPage.open(browser, `${server.url}?session=cube`);
  });
  afterAll(() => viewer.close());

  test("IsColouredByItsDistanceWithATable", async () => {
    const before = await canvasPicture(viewer);
    await choose("higher.msh", await exported("cube", "cube", () => 3));
    await found();
    expect(await measure("hd_max")).toBe(3);
    expect(await measure("hd_a_to_b")).toBe(3);
    expect(await measure("mean_a_to_b")).toBeGreaterThan(0.5);
    expect(await measure("mean_a_to_b")).toBeLessThan(3);
    expect(await viewer.page.textContent("#comparison-when")).toBe("cube at 0.000 s, tick 0");
    expect(await viewer.page.textContent("#comparison .legend-ticks")).toMatch(/^0.*3/);
    await viewer.page.waitForTimeout(1500);
    await viewer.saveScreenshot("compare-cube");
    expect(await changedFraction(browser, before, await canvasPicture(viewer))).toBeGreaterThan(0.02);
  });

  test("RepeatComparesTheCurrentState", async () => {
    await server.phrenic("step", "cube", "200");
    await viewer.waitForExactTick(200);
    await viewer.page.waitForFunction(() => document.querySelector("#comparison-time")?.textContent !== "");
    expect(await viewer.page.textContent("#comparison-time")).toMatch(/^Colours show the session at \d/);
    const before = await measure("rms_a_to_b");
    await viewer.page.click("#compare-repeat");
    await viewer.page.waitForSelector('#comparison-when:has-text("tick 200")');
    expect(await measure("rms_a_to_b")).not.toBe(before);
    expect(await viewer.page.textContent("#comparison-time")).toBe("");
  });

  test("TheSurfaceCanBeHidden", async () => {
    const before = await canvasPicture(viewer);
    await viewer.page.uncheck("#compare-drawn");
    const changed = async () => changedFraction(browser, before, await canvasPicture(viewer));
    await expect.poll(changed, { timeout: 20_000 }).toBeGreaterThan(0.005);
    await viewer.page.check("#compare-drawn");
  });

  test("AFileInMetresIsReadInMetres", async () => {
    await server.phrenic("reset", "cube");
    await viewer.waitForExactTick(0);
    const text = (await exported("cube", "cube", () => 3)).toString();
    const metres = text.replace(/(\$Nodes\n\d+\n)([^$]*)/, (_, head: string, lines: string) => {
      const scaled = lines
        .trimEnd()
        .split("\n")
        .map((line) => {
          const [id, ...x] = line.split(" ");
          return [id, ...x.map((value) => Number(value) / 1000)].join(" ");
        });
      return `${head}${scaled.join("\n")}\n`;
    });
    await viewer.page.selectOption("#compare-unit", "1000");
    await choose("metres.msh", Buffer.from(metres));
    await viewer.page.waitForSelector('#comparison h2:has-text("metres.msh")');
    expect(await measure("hd_max")).toBe(3);
    await viewer.page.selectOption("#compare-unit", "1");
  });

  test("AnInvalidFileIsRefusedWithItsLine", async () => {
    await choose("bad.obj", Buffer.from("v 0 0 0\nv 1 0 0\nv 0 1\nf 1 2 3\n"));
    const alert = viewer.page.locator('#comparison [role="alert"]');
    await alert.waitFor();
    expect(await alert.textContent()).toMatch(/^bad\.obj:3: /);
    await viewer.saveScreenshot("compare-bad");
    await viewer.page.click('#comparison button:has-text("Dismiss")');
    await alert.waitFor({ state: "hidden" });
  });

  test("ADroppedFileIsCompared", async () => {
    const text = (await exported("cube", "cube", () => 1)).toString();
    const transfer = await viewer.page.evaluateHandle((content) => {
      const data = new DataTransfer();
      data.items.add(new File([content], "dropped.msh"));
      return data;
    }, text);
    await viewer.page.dispatchEvent("#view", "dragover", { dataTransfer: transfer });
    await viewer.page.waitForSelector(".drop-zone:not([hidden])");
    await viewer.saveScreenshot("compare-drop");
    await viewer.page.dispatchEvent("#view", "drop", { dataTransfer: transfer });
    await viewer.page.waitForSelector('#comparison h2:has-text("dropped.msh")');
    expect(await measure("hd_max")).toBe(1);
  });

  test("HasNoAxeViolations", async () => {
    expect(await viewer.violations()).toEqual([]);
  });

  test("TheKeyboardRepeatsAndClears", async () => {
    await viewer.page.focus("#compare-repeat");
    await viewer.page.keyboard.press("Enter");
    await found();
    const coloured = await canvasPicture(viewer);
    await viewer.page.focus("#compare-clear");
    await viewer.page.keyboard.press("Enter");
    await viewer.page.waitForSelector("#comparison", { state: "hidden" });
    await viewer.page.waitForTimeout(1500);
    expect(await changedFraction(browser, coloured, await canvasPicture(viewer))).toBeGreaterThan(0.02);
    expect(viewer.consoleErrors).toEqual([]);
  });
});

test("OnAPhoneTheCardIsSmall", async () => {
  viewer = await ViewerPage.open(browser, `${server.url}?session=cube`, { width: 390, height: 780 });
  await choose("higher.msh", await exported("cube", "cube", () => 3));
  await found();
  await viewer.page.waitForTimeout(1500);
  await viewer.saveScreenshot("compare-phone");
  const card = (await viewer.page.locator("#comparison").boundingBox())!;
  const stage = (await viewer.page.locator("#stage").boundingBox())!;
  expect(card.x + card.width).toBeLessThanOrEqual(stage.width);
  expect(card.height).toBeLessThan(0.4 * stage.height);
  await viewer.close();
});

describe("the thorax compared with its diaphragm, its left side higher", () => {
  test("IsColouredOnThatSide", async () => {
    viewer = await ViewerPage.open(browser, `${server.url}?session=thorax`, { width: 1200, height: 720 });
    await server.phrenic("pause", "thorax");
    const file = await exported("thorax", "diaphragm", (x) => Math.max(0, x) / 10);
    await choose("left-higher.msh", file);
    await found();
    expect(await measure("hd_max")).toBeGreaterThan(5);
    expect(await measure("mean_a_to_b")).toBeLessThan(5);
    await viewer.page.waitForTimeout(1500);
    await viewer.saveScreenshot("compare-thorax");
    for (const name of ["Ribs", "Sternum", "Costal cartilages", "Lungs", "Heart"]) {
      const box = viewer.page.locator(".layer-name", { hasText: name }).locator("input");
      if ((await box.count()) === 1) await box.uncheck();
    }
    await viewer.page.waitForTimeout(1500);
    await viewer.saveScreenshot("compare-diaphragm");
    expect(viewer.consoleErrors).toEqual([]);
    await viewer.close();
  }, 240_000);
});
