import axe from "axe-core";
import { mkdirSync, readFileSync, writeFileSync } from "node:fs";
import { join } from "node:path";
import { pathToFileURL } from "node:url";
import type { Browser, Page } from "playwright-core";
import { afterAll, beforeAll, describe, expect, test } from "vitest";
import { costStudy, errorStudy, pageOf, stabilityStudy } from "../web/report/study_samples";
import { launchBrowser } from "./browser";
import { outFolder } from "./server";

const template = readFileSync(join(import.meta.dirname, "../../web/dist/report.html"), "utf8");
const studies = { error: errorStudy, stability: stabilityStudy, cost: costStudy };
let browser: Browser;

beforeAll(async () => {
  browser = await launchBrowser();
  mkdirSync(outFolder, { recursive: true });
});

afterAll(() => browser?.close());

/** Writes the page of a study to a file and opens it. */
async function open(name: string, study: object) {
  const path = join(outFolder, `report-${name}.html`);
  writeFileSync(path, pageOf(template, study));
  const page = await browser.newPage({ viewport: { width: 1280, height: 900 } });
  const complaints: string[] = [];
  const requests: string[] = [];
  page.on("console", (message) => complaints.push(message.text()));
  page.on("pageerror", (error) => complaints.push(String(error)));
  page.on("request", (request) => requests.push(request.url()));
  const url = pathToFileURL(path).href;
  await page.goto(url);
  await page.waitForSelector("#page footer");
  return { page, complaints, others: () => requests.filter((each) => each !== url && !each.startsWith("data:")) };
}

/** Returns a message for each text of a plot that leaves the plot or overlaps another text. */
function misplacedTexts(page: Page): Promise<string[]> {
  return page.evaluate(() =>
    [...document.querySelectorAll("svg.plot")].flatMap((svg) => {
      const frame = svg.getBoundingClientRect();
      const texts = [...svg.querySelectorAll("text")].filter((each) => each.textContent !== "");
      const boxes = texts.map((each) => ({ box: each.getBoundingClientRect(), words: each.textContent }));
      const out = boxes.filter(
        ({ box }) =>
          box.left < frame.left - 1 ||
          box.right > frame.right + 1 ||
          box.top < frame.top - 1 ||
          box.bottom > frame.bottom + 1,
      );
      const covered = boxes.filter(({ box }, i) =>
        boxes.some(
          ({ box: other }, j) =>
            j < i &&
            Math.min(box.right, other.right) - Math.max(box.left, other.left) > 2 &&
            Math.min(box.bottom, other.bottom) - Math.max(box.top, other.top) > 3,
        ),
      );
      return [...out.map(({ words }) => `${words} sticks out`), ...covered.map(({ words }) => `${words} covers`)];
    }),
  );
}

describe.each(Object.entries(studies))("the page of the %s study", (name, study) => {
  test("HasNoConsoleErrorsAndNoRequests", async () => {
    const { page, complaints, others } = await open(name, study);
    await page.screenshot({ path: join(outFolder, `report-${name}.png`), fullPage: true });
    expect(complaints).toEqual([]);
    expect(others()).toEqual([]);
    expect(await page.locator("figure svg[role=img][aria-label]").count()).toBeGreaterThan(2);
    expect(await page.locator("tbody tr").count()).toBeGreaterThan(5);
    expect(await misplacedTexts(page)).toEqual([]);
    await page.close();
  });

  test("HasNoAxeViolations", async () => {
    const { page } = await open(name, study);
    await page.evaluate(axe.source);
    const found = await page.evaluate(async () => {
      const { violations } = await (window as unknown as { axe: typeof axe }).axe.run();
      return violations.map(({ id, nodes }) => `${id}: ${nodes.map((node) => node.target).join(", ")}`);
    });
    expect(found).toEqual([]);
    await page.close();
  });
});

test("TheSecurityPolicyBlocksOtherScripts", async () => {
  const { page } = await open("error", errorStudy);
  const ran = await page.evaluate(async () => {
    const script = document.createElement("script");
    script.textContent = "window.intruder = true";
    document.body.append(script);
    return "intruder" in window;
  });
  expect(ran).toBe(false);
  await page.close();
});

test("TheLargestErrorCanBeSelected", async () => {
  const { page, complaints } = await open("error", errorStudy);
  await page.getByLabel("Largest error").check();
  await page.waitForSelector('figure svg[aria-label^="Largest error"]');
  expect(complaints).toEqual([]);
  await page.close();
});
