import { join } from "node:path";
import type { Browser } from "playwright-core";
import { afterAll, beforeAll, expect, test } from "vitest";
import { endAll, slowDisplay, startAll, ViewerPage } from "./browser";
import { keysOfSources } from "../web/language/keys";
import { outFolder, type Server } from "./server";

let server: Server;
let browser: Browser;

beforeAll(async () => {
  [browser, server] = await startAll();
});

afterAll(() => endAll(browser, server));

const student = () => `${server.url}?session=thorax&view=student`;

const sizes = [[1440, 900], [1000, 700], [768, 1024], [600, 360], [320, 640]]; // prettier-ignore

/** Pictures of the page at several widths; nothing is cut off at the right. */
async function picturesOf(page: ViewerPage["page"], name: string, of = sizes): Promise<void> {
  for (const [width, height] of of) {
    await page.setViewportSize({ width, height });
    await page.waitForTimeout(500);
    const widest = () =>
      Math.max(
        ...[...document.querySelectorAll("#student *, #header *")].map((each) => each.getBoundingClientRect().right),
      );
    expect(await page.evaluate(widest)).toBeLessThanOrEqual(width + 1);
    await page.screenshot({ path: join(outFolder, `${name}-${width}.png`) });
  }
}

test("AClassChoosesABreathAndMovesASlider", async () => {
  const viewer = await ViewerPage.open(browser, student(), { width: 1440, height: 900 });
  const { page } = viewer;
  const stage = (await page.locator("#stage").boundingBox())!;
  expect(stage.width / 1440).toBeCloseTo(0.7, 1);
  await page.setViewportSize({ width: 900, height: 620 });
  expect(await page.locator("#panel").isVisible()).toBe(false);
  await page.getByRole("button", { name: "Ill", exact: true }).click();
  await page.getByRole("button", { name: "Right palsy" }).click();
  await page.waitForSelector('[data-preset="palsy-right"][aria-pressed="true"]');
  await page.locator("#motion-words", { hasText: "paradoxical motion" }).waitFor({ timeout: 60_000 });
  expect(await page.textContent("#student")).not.toMatch(/tick|tensegrity|solver|activation/i);
  expect(await viewer.violations()).toEqual([]);
  await picturesOf(viewer.page, "student");
  await page.setViewportSize({ width: 1440, height: 900 });
  await page.getByLabel("How fast").focus();
  await page.keyboard.press("End");
  await expect.poll(async () => (await server.session()).parameters.breath_length).toBe(1);
  expect(viewer.consoleErrors).toEqual([]);
  await viewer.close();
});

test("TheLightPageHasNoAxeViolations", async () => {
  const viewer = await ViewerPage.open(browser, student(), { width: 1440, height: 900 }, "light");
  await viewer.page.waitForSelector("#choices:not([hidden])");
  expect(await viewer.violations()).toEqual([]);
  await viewer.saveScreenshot("student-light");
  await viewer.page.keyboard.press("e");
  expect(await viewer.violations()).toEqual([]);
  await viewer.saveScreenshot("expert-light");
  await viewer.close();
});

test("TheViewIsInTheAddressAndRemembered", async () => {
  const viewer = await ViewerPage.open(browser, student());
  const { page } = viewer;
  expect(new URL(page.url()).searchParams.get("view")).toBe("student");
  await page.getByRole("button", { name: "Expert" }).click();
  expect(await page.locator("#panel").isVisible()).toBe(true);
  expect(new URL(page.url()).searchParams.get("view")).toBe("expert");
  await page.keyboard.press("e");
  expect(new URL(page.url()).searchParams.get("view")).toBe("student");
  await page.goto(server.url);
  await viewer.waitForPicture();
  expect(await page.locator("#student").isVisible()).toBe(true);
  await viewer.close();
});

test("OneKeyComparesWithHealthAndEndsTheCopy", { timeout: 240_000 }, async () => {
  const viewer = await ViewerPage.open(browser, student());
  const { page } = viewer;
  await page.getByRole("button", { name: "Ill", exact: true }).click();
  await page.getByRole("button", { name: "Right palsy" }).click();
  await page.focus("#view");
  await page.keyboard.press("b");
  await page.waitForURL(/beside=/);
  const copy = new URL(page.url()).searchParams.get("beside");
  await viewer.waitForPicture();
  const words = () => page.textContent("#motion-words");
  await expect.poll(words, { timeout: 180_000 }).toContain("Quiet, supine: both domes fall");
  expect(await words()).toMatch(
    /The right dome rises by \d+ mm while the left falls by \d+ mm: paradoxical motion\. A breath brings 0\.\d\d l of air instead of 0\.\d\d\./,
  );
  expect(await page.locator('[data-graph="dome-height"] .key').count()).toBe(4);
  expect(await viewer.violations()).toEqual([]);
  await picturesOf(viewer.page, "student-compare");
  await page.focus("#view");
  await page.keyboard.press("b");
  await page.waitForURL((url) => !url.search.includes("beside"));
  const { sessions } = JSON.parse(await server.phrenic("sessions", "-o", "json"));
  const ids = sessions.map(({ id }: { id: string }) => id);
  expect(ids).toContain("thorax");
  expect(ids).not.toContain(copy);
  expect(viewer.consoleErrors).toEqual([]);
  await viewer.close();
});

test("ABreathIsPredictedPlayedAndMeasured", async () => {
  const viewer = await ViewerPage.open(browser, student());
  const { page } = viewer;
  await page.getByRole("button", { name: "Predict the next breath" }).click();
  await page.waitForSelector('#play[aria-label="Play"]');
  await page.locator("#prediction svg").scrollIntoViewIfNeeded();
  const box = (await page.locator("#prediction svg").boundingBox())!;
  const [x, y] = [(part: number) => box.x + part * box.width, (part: number) => box.y + part * box.height];
  await page.mouse.move(x(0.01), y(0.7));
  await page.mouse.down();
  await page.mouse.move(x(0.5), y(0.2), { steps: 8 });
  await page.mouse.move(x(0.99), y(0.7), { steps: 8 });
  await page.mouse.up();
  expect(await viewer.violations()).toEqual([]);
  await page.getByRole("button", { name: "Play and see" }).click();
  await page
    .locator("#prediction-words", { hasText: /On average they are 0\.\d\d l apart/ })
    .waitFor({ timeout: 60_000 });
  await viewer.saveScreenshot("student-prediction");
  expect(viewer.consoleErrors).toEqual([]);
  await viewer.close();
});

/** A catalogue that marks each text, so that one without a translation stands out. */
const marked = Object.fromEntries([...keysOfSources()].map((key) => [key, `⟦${key}⟧`]));

/** Texts that are the same in every language: names, and units. */
const alike = /^(Phrenic|thorax|SVG|CSV|EN|DE|ES|\d+ (fps|mm).*|[\d.,−-]+ (s|mm|Pa))$/;

/** Returns the texts of the page that are seen or spoken and have no mark. */
function unmarked(): string[] {
  const found = [...document.body.querySelectorAll("*")].flatMap((element) => {
    const shown = element.closest("select") ?? element;
    if (!shown.checkVisibility({ visibilityProperty: true }) || element.closest("script, noscript, svg") !== null)
      return [];
    const texts = [...element.childNodes]
      .filter(({ nodeType }) => nodeType === 3)
      .map(({ nodeValue }) => nodeValue ?? "");
    const spoken = ["title", "aria-label", "placeholder"].map((name) => element.getAttribute(name) ?? "");
    return [...texts, ...(element.tagName === "OPTION" ? [] : spoken)];
  });
  return [...new Set(found.map((text) => text.trim()))].filter((text) => /\p{L}{2}/u.test(text) && !text.includes("⟦"));
}

test("NoTextOfTheStudentViewIsWithoutATranslation", async () => {
  const context = await browser.newContext({ viewport: { width: 1280, height: 800 }, locale: "de-DE" });
  await slowDisplay(context);
  await context.route("**/languages/de.json", (route) => route.fulfill({ json: marked }));
  const page = await context.newPage();
  const left = async () => (await page.evaluate(unmarked)).filter((text) => !alike.test(text));
  await page.goto(student());
  await page.locator("#motion-words", { hasText: "⟦" }).waitFor();
  await page.waitForFunction(() => (window.phrenic?.tick() ?? -1) >= 0);
  expect(await left()).toEqual([]);
  for (const dialog of ["share-open", "help-open", "control-badge"]) {
    await page.click(`#${dialog}`);
    expect(await left(), dialog).toEqual([]);
    await page.keyboard.press("Escape");
  }
  await page.click("#lessons summary");
  await page.click("#make-lesson");
  await page.click("#step-form summary");
  expect(await left(), "the maker of lessons").toEqual([]);
  await context.close();
});

test("TheLanguageIsChosenAndKeptAndNothingIsCutOff", async () => {
  const context = await browser.newContext({ viewport: { width: 1440, height: 900 }, locale: "es-ES" });
  await slowDisplay(context);
  const page = await context.newPage();
  await page.goto(`${server.url}?session=thorax&lesson=paralysis&step=2`);
  await page.getByRole("heading", { name: "El nervio derecho está cortado" }).waitFor();
  expect(await page.evaluate(() => document.documentElement.lang)).toBe("es");
  await page.selectOption("#language", "de");
  await page.getByRole("heading", { name: "Der rechte Nerv ist durchtrennt" }).waitFor();
  await page.getByRole("radio", { name: "Der Druck über ihr fällt, und sie kann nicht dagegen ziehen." }).check();
  await page.getByRole("button", { name: "Prüfen" }).click();
  await page.getByText("Richtig. Die Lungen ziehen an beiden Kuppeln.").waitFor();
  await page.locator("#motion-words", { hasText: /um \d+ mm.*\d,\d\d l Luft/ }).waitFor({ timeout: 60_000 });
  for (const language of ["de", "es"]) {
    await page.goto(`${student()}&lang=${language}`);
    await page.waitForFunction(() => (window.phrenic?.tick() ?? -1) >= 0);
    await picturesOf(page, `student-${language}`, [[320, 640], [768, 1024], [1280, 800]]); // prettier-ignore
  }
  await context.close();
});
