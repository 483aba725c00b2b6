import { join } from "node:path";
import { test } from "vitest";
import { launchBrowser, ViewerPage } from "./browser";
import { bodySheet, contactSheet } from "./contact_sheet";
import { outFolder, Server } from "./server";

const web = join(import.meta.dirname, "../../web");
const rest = join(outFolder, "rest.msh");
const mediastinum = ["Heart", "Aorta", "Caval veins", "Windpipe and bronchi", "Gullet"];

// Not tests: `npm run screenshot` takes the screenshots of the README, during inspiration.
test("Screenshot", { timeout: 300_000 }, async () => {
  const browser = await launchBrowser();
  const server = await Server.start();
  try {
    const viewer = await ViewerPage.open(browser, server.url, { width: 1200, height: 720 });
    const { page } = viewer;
    await page.click('#play[aria-label="Pause"]');
    await page.click("#reset");
    await page.waitForFunction(() => window.phrenic!.tick() === 0);
    await server.phrenic("export", "thorax", rest, "--seconds", "0", "--body", "diaphragm");
    await page.selectOption("#stride", "1000");
    while ((await page.evaluate(() => window.phrenic!.time())) < 0.5) {
      const before = await viewer.tick();
      await page.click("#step");
      await viewer.waitForTick(before);
    }
    // The canvas is drawn at full resolution when nothing moves.
    await page.selectOption("#quality", "full");
    await page.mouse.move(0, 0);
    await page.waitForTimeout(6000);
    await page.screenshot({ path: join(web, "screenshot.png") });
    await page.selectOption("#quality", "automatic");
    // The same state compared with the diaphragm at rest.
    await page.setInputFiles("#compare-file", rest);
    await page.waitForSelector("#comparison .result:not([hidden])");
    for (const layer of ["Ribs", "Sternum", "Costal cartilages", "Lungs", ...mediastinum])
      await page.uncheck(`[aria-label="Show ${layer}"]`);
    await page.mouse.move(0, 0);
    await page.waitForTimeout(4000);
    await page.screenshot({ path: join(web, "comparison.png") });
    // A paralysed right hemidiaphragm and a healthy one side by side, at the same phase of the breath.
    await page.goto(server.url);
    await viewer.waitForPicture();
    await page.getByLabel("Compare with", { exact: true }).selectOption({ label: "Right palsy" });
    await page.waitForURL(/beside=/);
    await viewer.waitForPicture();
    await page.click("#reset");
    await page.waitForFunction(() => window.phrenic!.tick() === 0);
    await page.selectOption("#stride", "100");
    while ((await page.evaluate(() => window.phrenic!.time())) < 2) {
      const before = await viewer.tick();
      await page.click("#step");
      await viewer.waitForTick(before);
    }
    await page.selectOption("#coloring-kind", "displacement");
    for (const layer of ["Ribs", "Sternum", "Costal cartilages", ...mediastinum])
      await page.uncheck(`[aria-label="Show ${layer}"]`);
    await page.mouse.move(0, 0);
    await page.waitForTimeout(4000);
    await page.screenshot({ path: join(web, "paralysis.jpg"), type: "jpeg", quality: 85 });
  } finally {
    await browser.close();
    await server.end();
  }
});

// `npm run screenshot -- -t ContactSheet`: seven causes of breathing, side by side.
test("ContactSheet", { timeout: 900_000 }, async () => {
  const browser = await launchBrowser();
  const server = await Server.start("none");
  try {
    await contactSheet(browser, server, join(web, "breathing.jpg"));
  } finally {
    await browser.close();
    await server.end();
  }
});

// `npm run screenshot -- -t Bodies`: ten bodies at rest, side by side.
test("Bodies", { timeout: 900_000 }, async () => {
  const browser = await launchBrowser();
  const server = await Server.start("none");
  try {
    await bodySheet(browser, server, join(web, "bodies.jpg"));
  } finally {
    await browser.close();
    await server.end();
  }
});

// `npm run screenshot -- -t Fluoroscopy`: a sniff with a paralysed right hemidiaphragm, by X-rays.
test("Fluoroscopy", { timeout: 300_000 }, async () => {
  const browser = await launchBrowser();
  const server = await Server.start("none");
  try {
    await server.phrenic("create", "thorax", "--id", "palsy", "--preset", "palsy-right", "--play");
    const viewer = await ViewerPage.open(browser, `${server.url}?session=palsy&view=student`, {
      width: 1240,
      height: 760,
    });
    const { page } = viewer;
    await page.click("#fluoroscopy-open");
    await page.click("#sniff-run");
    await page.getByText("most of 3 sniffs").waitFor({ timeout: 120_000 });
    await page.click('#play[aria-label="Pause"]');
    await page.mouse.move(0, 0);
    await page.waitForTimeout(3000);
    await page.locator("#fluoroscopy").screenshot({ path: join(web, "fluoroscopy.jpg"), type: "jpeg", quality: 85 });
  } finally {
    await browser.close();
    await server.end();
  }
});
