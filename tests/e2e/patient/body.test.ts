import type { Browser } from "playwright-core";
import { afterAll, beforeAll, expect, test } from "vitest";
import { nodeApi } from "../node_api";
import { endAll, startAll, ViewerPage } from "../browser";
import type { Server } from "../server";

let server: Server;
let browser: Browser;

beforeAll(async () => {
  [browser, server] = await startAll("none");
  await server.phrenic("create", "cube-springs", "--id", "cube");
});

afterAll(() => endAll(browser, server));

async function openDialog(width: number, height: number): Promise<ViewerPage> {
  const viewer = await ViewerPage.open(browser, `${server.url}?session=cube`, { width, height });
  await viewer.waitForPicture();
  await viewer.page.click("#session");
  await viewer.page.click("#body-new");
  await viewer.page.waitForSelector("#body[open]");
  return viewer;
}

test("ASmallWomanChosenInThePageBreathesAsTheOneOfTheCommandLine", async () => {
  const viewer = await openDialog(1280, 900);
  const { page } = viewer;
  expect(await viewer.violations()).toEqual([]);
  await viewer.saveScreenshot("body_dialog");
  await page.getByRole("button", { name: "Small woman, 1.5 m" }).click();
  await page.fill("#parameter-age-entry", "95");
  await page.press("#parameter-age-entry", "Enter");
  expect(await page.textContent("#parameter-age-fault")).toBe("Age must be between 20 and 90 years.");
  await page.fill("#parameter-age-entry", "80");
  await page.press("#parameter-age-entry", "Enter");
  await viewer.saveScreenshot("body_small_woman");
  await page.click("#body-start");
  await page.waitForURL((url) => url.searchParams.get("session") !== "cube", { timeout: 240_000 });
  await viewer.waitForPicture();
  await viewer.saveScreenshot("body_breathes");
  const id = new URL(page.url()).searchParams.get("session")!;
  const body = ["sex=female", "height=1.5", "age=80"].flatMap((number) => ["--physique", number]);
  await server.phrenic("create", "thorax", "--id", "typed", ...body);
  const { sessions } = nodeApi(server.url);
  const hashOf = async (sessionId: string) => (await sessions.getSession({ sessionId })).report!.sceneHash;
  expect(await hashOf(id)).toBe(await hashOf("typed"));
});

test("TheDialogFitsAPhoneAndHasNoAxeViolations", async () => {
  const viewer = await openDialog(390, 780);
  const { page } = viewer;
  await page.emulateMedia({ colorScheme: "light" });
  for (const control of await page.locator("#body :is(button, input, select)").all()) {
    const box = (await control.boundingBox())!;
    expect(box.x).toBeGreaterThanOrEqual(0);
    expect(box.x + box.width).toBeLessThanOrEqual(390);
  }
  expect(await viewer.violations()).toEqual([]);
  await viewer.saveScreenshot("body_phone");
});
