import type { Browser, Page } from "playwright-core";
import { afterAll, beforeAll, expect, test } from "vitest";
import { endAll, startAll, ViewerPage } from "./browser";
import type { Server } from "./server";

let server: Server;
let browser: Browser;

beforeAll(async () => {
  [browser, server] = await startAll();
  await server.phrenic("pause", "thorax");
});

afterAll(() => endAll(browser, server));

/** Presses Tab until the focus is on the element; returns how often. */
async function tabsTo(page: Page, selector: string): Promise<number> {
  for (let count = 1; count < 60; count++) {
    await page.keyboard.press("Tab");
    if (await page.evaluate((wanted) => document.activeElement?.matches(wanted), selector)) return count;
  }
  throw new Error(`${selector} cannot be reached by the Tab key.`);
}

test("ATeacherMakesALessonAndSeesTheAnswerOfAPupil", async () => {
  const teacher = await ViewerPage.open(browser, `${server.url}?session=thorax&view=student`);
  const { page } = teacher;
  // The comparison is reached from the start of the page by few keys.
  const skip = (await tabsTo(page, '#skip a[href="#panel"]')) + 1;
  await page.keyboard.press("Enter");
  expect(skip + (await tabsTo(page, "#compare-healthy"))).toBeLessThan(10);
  await page.getByText("Lessons", { exact: true }).click();
  await page.getByRole("button", { name: "Make a lesson" }).click();
  await page.fill("#step-title", "Look at the domes");
  await page.fill("#step-caption", "Two domes lie under the lungs.");
  await page.getByText("A question", { exact: true }).click();
  await page.fill("#step-question", "How many domes are there?");
  await page.fill("#step-answers", "one\n* two");
  await page.fill("#step-explanation", "A right and a left one.");
  await page.click("#keep-view");
  await page.waitForSelector("#maker-steps li");
  await page.fill("#maker-title", "Domes");
  expect(await teacher.violations()).toEqual([]);
  await teacher.saveScreenshot("lesson-maker");
  const [file] = await Promise.all([
    page.waitForEvent("download"),
    page.getByRole("button", { name: "Save as file" }).click(),
  ]);
  await page.getByRole("button", { name: "Save and play" }).click();
  await page.getByRole("heading", { name: "Look at the domes" }).waitFor();

  const pupil = await ViewerPage.open(browser, `${server.url}?session=thorax&view=student`);
  await pupil.page.getByText("Lessons", { exact: true }).click();
  await pupil.page.setInputFiles("#lesson-file", (await file.path())!);
  await pupil.page.getByRole("heading", { name: "Look at the domes" }).waitFor();
  await pupil.page.getByLabel("two").check();
  await pupil.page.getByRole("button", { name: "Check" }).click();
  await pupil.page.getByText("Right. A right and a left one.").waitFor();

  await page.getByText("Answers of the class", { exact: true }).click();
  await page.getByText("1 answered, 1 right, 1 at the first attempt.").waitFor();
  expect(await teacher.violations()).toEqual([]);
  await teacher.saveScreenshot("class-results");
  expect([...teacher.consoleErrors, ...pupil.consoleErrors]).toEqual([]);
  await Promise.all([teacher.close(), pupil.close()]);
});
