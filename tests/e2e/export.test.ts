import { validateBytes } from "gltf-validator";
import { createHash } from "node:crypto";
import { readFile } from "node:fs/promises";
import { join } from "node:path";
import type { Browser } from "playwright-core";
import { afterAll, beforeAll, expect, test } from "vitest";
import { endAll, startAll, ViewerPage } from "./browser";
import { outFolder, type Server } from "./server";

let server: Server;
let browser: Browser;
let viewer: ViewerPage;

beforeAll(async () => {
  [browser, server] = await startAll();
  await server.phrenic("create", "cube-tensegrity", "--id", "cube");
  viewer = await ViewerPage.open(browser, `${server.url}?session=cube`);
});

afterAll(async () => {
  await viewer?.close();
  await endAll(browser, server);
});

test("AGltfMotionPassesTheKhronosValidator", async () => {
  for (const [session, ...bodies] of [["cube"], ["thorax", "--body", "ribs", "--body", "diaphragm"]]) {
    const path = join(outFolder, `${session}.glb`);
    await server.phrenic("export", session!, path, "--seconds", "2", "--fps", "3", ...bodies);
    const { issues, info } = await validateBytes(new Uint8Array(await readFile(path)));
    expect(issues.messages.filter(({ severity }) => severity < 2)).toEqual([]);
    expect(info).toMatchObject({ version: "2.0", animationCount: 1, hasMorphTargets: true });
  }
});

test("ThePanelExportsTheSameFileAsTheCommandLine", async () => {
  await viewer.page.click('summary:has-text("Export the motion")');
  await viewer.page.selectOption("#export-format", "depl");
  await viewer.page.fill("#export-seconds", "0.5");
  await viewer.page.click("#export");
  const link = viewer.page.locator("#export-link");
  await link.waitFor();
  expect(await viewer.violations()).toEqual([]);
  await viewer.saveScreenshot("export");
  const [download] = await Promise.all([viewer.page.waitForEvent("download"), link.click()]);
  expect(download.suggestedFilename()).toBe("cube.depl");
  const path = join(outFolder, "cube.depl");
  await server.phrenic("export", "cube", path, "--seconds", "0.5");
  const hash = async (file: string) =>
    createHash("sha256")
      .update(await readFile(file))
      .digest("hex");
  expect(await hash((await download.path())!)).toBe(await hash(path));
  expect(JSON.parse(await server.phrenic("exports", "list", "-o", "json")).exports).toEqual([]);
});

test("ThePageOfABreathIsTheSameFileFromThePanelAndTheCommandLine", async () => {
  await viewer.page.selectOption("#export-format", "html");
  await viewer.page.click("#export");
  const link = viewer.page.locator('#export-link[download$=".html"]');
  const [download] = await Promise.all([viewer.page.waitForEvent("download"), link.click()]);
  const path = join(outFolder, "cube.html");
  await server.phrenic("export", "cube", path);
  expect((await readFile((await download.path())!)).equals(await readFile(path))).toBe(true);
});

test("AMotionDownloadedFromThePanelIsValid", async () => {
  await viewer.page.selectOption("#export-format", "glb");
  await viewer.page.click("#export");
  const link = viewer.page.locator("#export-link");
  await viewer.page.waitForSelector('#export-link[download$=".glb"]');
  const [download] = await Promise.all([viewer.page.waitForEvent("download"), link.click()]);
  const { issues, info } = await validateBytes(new Uint8Array(await readFile((await download.path())!)));
  expect(issues.messages.filter(({ severity }) => severity < 2)).toEqual([]);
  expect(info).toMatchObject({ animationCount: 1 });
});

test("AnUploadedSurfaceIsReportedAndAnInvalidOneRefusedWithItsLine", async () => {
  const choose = (text: string) =>
    viewer.page.setInputFiles("#upload-file", { name: "a.obj", mimeType: "text/plain", buffer: Buffer.from(text) });
  await viewer.page.click('summary:has-text("Surface files")');
  await choose("v 0 0 0\nv 1 0\nf 1 2 3\n");
  await viewer.page.waitForSelector('#upload-progress [role="alert"]:has-text("a.obj:2:")');
  await choose("v 0 0 0\nv 30 0 0\nv 0 30 0\nf 1 2 3\n");
  await viewer.page.waitForSelector("#upload-path");
  expect(await viewer.page.inputValue("#upload-path")).toMatch(/^upload:[0-9a-f]{64}$/);
  await viewer.saveScreenshot("upload");
  expect(viewer.consoleErrors).toEqual([]);
});
