import { join } from "node:path";
import { test } from "vitest";
import { launchBrowser, ViewerPage } from "./browser";
import { Server } from "./server";

// Not a test: `npm run screenshot` makes the picture that the README shows, from the front at a quarter of a breath.
test("Screenshot", async () => {
  const browser = await launchBrowser();
  const server = await Server.start();
  try {
    const viewer = await ViewerPage.open(browser, server.url, { width: 1280, height: 760 });
    await viewer.waitForLink("live");
    await viewer.page.waitForFunction(() => window.phrenic!.time() > 1, null, { timeout: 60_000 });
    // At rest the picture is drawn in full.
    await viewer.page.click('#play[aria-label="Pause"]');
    await viewer.page.waitForTimeout(4000);
    await viewer.page.screenshot({ path: join(import.meta.dirname, "../../web/screenshot.png") });
  } finally {
    await browser.close();
    await server.kill();
  }
});
