import type { Browser } from "playwright-core";
import { afterAll, beforeAll, expect, test } from "vitest";
import { launchBrowser, ViewerPage } from "./browser";
import { Server } from "./server";

let server: Server;
let browsers: Browser[];
let teacher: ViewerPage;
let pupil: ViewerPage;

/** Opens the dialog, runs `act`, and closes it. */
async function inDialog(viewer: ViewerPage, act: () => Promise<void>): Promise<void> {
  await viewer.page.click("#control-badge");
  await act();
  await viewer.page.keyboard.press("Escape");
}

const enter = (viewer: ViewerPage, name: string) =>
  inDialog(viewer, async () => {
    await viewer.page.fill("#control-name", name);
    await viewer.page.click("#control-enter");
    await viewer.page.waitForSelector(`[data-person="${name}"]`);
  });

const press = (viewer: ViewerPage, id: string) => inDialog(viewer, () => viewer.page.click(`#control-${id}`));

const badge = (viewer: ViewerPage, words: string) =>
  viewer.page.waitForSelector(`#control-badge:has-text("${words}")`, { timeout: 30_000 });

/** Returns the camera position [m]. */
const eye = (viewer: ViewerPage) => viewer.page.evaluate(() => window.phrenic!.eye());

const apart = (a: number[], b: number[]) => Math.hypot(...a.map((value, i) => value - b[i]));

beforeAll(async () => {
  server = await Server.start("cube-tensegrity");
  browsers = [await launchBrowser(), await launchBrowser()];
  teacher = await ViewerPage.open(browsers[0], server.url);
  // The teacher creates and owns this session; the class joins by its link.
  await teacher.page.click("#share-open");
  const opened = teacher.page.waitForURL(/cube-tensegrity-2/, { waitUntil: "commit", timeout: 60_000 });
  await Promise.all([opened, teacher.page.click("#share-fork")]);
  await teacher.waitForPicture();
  pupil = await ViewerPage.open(browsers[1], teacher.page.url());
});

afterAll(async () => {
  for (const browser of browsers ?? []) await browser.close();
  await server?.end();
});

test("EveryoneMayChangeTheSessionUntilItsOwnerTakesControl", async () => {
  await badge(pupil, "Everyone controls");
  await pupil.page.click('#play[aria-label="Pause"]');
  await teacher.page.waitForSelector('#play[aria-label="Play"]');
  await enter(teacher, "Anna");
  await enter(pupil, "Ben");
  await press(teacher, "take");
  await badge(teacher, "You control");
  await badge(pupil, "Anna controls");
});

test("ControlsOfOthersAreDisabledWithAReason", async () => {
  expect(await pupil.page.isDisabled("#play")).toBe(true);
  expect(await pupil.page.isDisabled("#parameter-breathForce")).toBe(true);
  expect(await pupil.page.getAttribute("fieldset.controlled", "title")).toContain("Anna controls this session");
  expect(await teacher.page.isDisabled("#play")).toBe(false);
  await pupil.saveScreenshot("controlled");
});

test("TheServerRefusesChangesByOthers", async () => {
  const id = "cube-tensegrity-2";
  await expect(server.phrenic("set", id, "breath_force=2")).rejects.toThrow(/controlled by Anna/);
});

test("ARequestIsShownAndControlHandedOver", async () => {
  await press(pupil, "take");
  await badge(teacher, "Ben asks");
  await teacher.page.click("#control-badge");
  await teacher.saveScreenshot("control-dialog");
  await teacher.page.click('[data-person="Ben"] button');
  await teacher.page.keyboard.press("Escape");
  await badge(pupil, "You control");
  await badge(teacher, "Ben controls");
  await pupil.page.click("#play");
  await teacher.page.waitForSelector('#play[aria-label="Pause"]');
  expect(await teacher.page.isDisabled("#play")).toBe(true);
});

test("TheOwnerTakesControlBack", async () => {
  await press(teacher, "take");
  await badge(pupil, "Anna controls");
  expect(await pupil.page.isDisabled("#play")).toBe(true);
});

test("TheViewOfThePupilFollowsTheTeachers", async () => {
  await teacher.page.focus("#view");
  for (let i = 0; i < 6; i++) await teacher.page.keyboard.press("ArrowLeft");
  const moved = await eye(teacher);
  expect(apart(moved, await eye(pupil))).toBeGreaterThan(0.01);
  await inDialog(pupil, () => pupil.page.check("#control-follow"));
  const wait = (goal: number[]) =>
    pupil.page.waitForFunction(
      (to) => Math.hypot(...window.phrenic!.eye().map((value, i) => value - to[i])) < 1e-3 * Math.hypot(...to),
      goal,
      { timeout: 30_000 },
    );
  await wait(moved);
  for (let i = 0; i < 4; i++) await teacher.page.keyboard.press("ArrowUp");
  await wait(await eye(teacher));
});

test("ALaterViewerSeesWhoControls", async () => {
  const late = await ViewerPage.open(browsers[1], teacher.page.url());
  await badge(late, "Anna controls");
  await late.close();
});

test("AReloadedPageKeepsControl", async () => {
  await teacher.page.reload();
  await teacher.waitForPicture();
  await badge(teacher, "You control");
});

test("TheOwnerMayLetEveryoneControl", async () => {
  await press(teacher, "open");
  await badge(pupil, "Everyone controls");
  expect(await pupil.page.isDisabled("#play")).toBe(false);
});

test("ThereWereNoConsoleErrors", () => {
  expect([...teacher.consoleErrors, ...pupil.consoleErrors]).toEqual([]);
});
