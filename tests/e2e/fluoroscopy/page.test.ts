import { readFileSync } from "node:fs";
import { join } from "node:path";
import type { Browser } from "playwright-core";
import { afterAll, beforeAll, describe, expect, test } from "vitest";
import { ball } from "../../web/fluoroscopy/ball";
import { endAll, startAll, ViewerPage } from "../browser";
import { outFolder, type Server } from "../server";

let server: Server;
let browser: Browser;
let viewer: ViewerPage;

beforeAll(async () => {
  [browser, server] = await startAll("none");
  await server.phrenic("create", "thorax", "--id", "still");
  viewer = await ViewerPage.open(browser, `${server.url}?session=still`, { width: 1280, height: 900 });
  await open(viewer);
});

afterAll(() => endAll(browser, server));

async function open({ page }: ViewerPage): Promise<void> {
  await page.click("#fluoroscopy-open");
  await page.waitForSelector("#fluoroscopy");
  await page.waitForFunction(() => window.phrenic!.fluoroscopy()!.sums.some((each) => each > 1), null, {
    timeout: 20_000,
  });
}

const sums = () => viewer.page.evaluate(() => [...window.phrenic!.fluoroscopy()!.sums]);

/** Corners of a box around the origin with these half edges [m], and its triangles, which face outwards. */
function box(x: number, y: number, z: number): { vertices: number[]; triangles: number[] } {
  const vertices = [0, 1, 2, 3, 4, 5, 6, 7].flatMap((i) => [i & 1 ? x : -x, i & 2 ? y : -y, i & 4 ? z : -z]);
  const faces = [0, 2, 3, 1, 4, 5, 7, 6, 0, 1, 5, 4, 2, 6, 7, 3, 0, 4, 6, 2, 1, 3, 7, 5];
  return { vertices, triangles: [0, 4, 8, 12, 16, 20].flatMap((f) => [0, 1, 2, 0, 2, 3].map((k) => faces[f + k])) };
}

/** The thickness of a surface along each ray [m], as the page's graphics compute it. */
function thickness(
  surface: { vertices: number[]; triangles: number[] },
  lao: number,
  source?: number,
): Promise<number[]> {
  return viewer.page.evaluate(
    ([{ vertices, triangles }, angle, distance]) => {
      const arm = { lao: angle, cranial: 0, sourceToDetector: distance };
      return [...window.phrenic!.fluoroscopy()!.thickness(vertices, triangles, arm)];
    },
    [surface, lao, source] as const,
  );
}

/** Half the width of the picture, and the distance from the detector to the isocentre [m], as the page has them. */
const [halfWidth, behind] = [0.21, 0.3];

describe("the pixels of the page", () => {
  test.each([
    [0, undefined],
    [40, undefined],
    [0, 1.8],
    [-30, 1],
  ])("HaveTheChordsOfABallWithinOnePercent at %d degrees, source %s", async (lao, source) => {
    const { vertices, triangles } = ball(0.1);
    const picture = await thickness({ vertices: [...vertices], triangles: [...triangles] }, lao, source);
    const size = Math.sqrt(picture.length);
    let [largest, through] = [0, 0];
    picture.forEach((each, i) => {
      const at = (pixel: number) => ((pixel + 0.5) / size) * 2 * halfWidth - halfWidth;
      let miss = Math.hypot(at(Math.floor(i / size)), at(i % size));
      if (source !== undefined) miss *= (source - behind) / Math.hypot(source - behind, miss);
      if (miss > 0.1) return expect(Math.abs(each)).toBeLessThan(1e-5);
      const chord = 2 * Math.sqrt(0.01 - miss ** 2);
      if (chord < 0.06) return; // the polyhedron is flat at its edge
      through++;
      largest = Math.max(largest, Math.abs(each - chord) / chord);
    });
    console.log(`${through} rays through the ball, largest error ${(100 * largest).toFixed(2)} %`);
    expect(through).toBeGreaterThan(10_000);
    expect(largest).toBeLessThan(0.01);
  });

  test("HaveTheThicknessOfASlabWithinOnePercent", async () => {
    for (const lao of [0, 45]) {
      const picture = await thickness(box(1, 0.03, 1), lao);
      const wanted = 0.06 / Math.cos((lao * Math.PI) / 180);
      expect(Math.max(...picture.slice(0, 5000).map((each) => Math.abs(each / wanted - 1)))).toBeLessThan(0.01);
    }
  });

  test("AreTheNumbersOfTheCommandLine", async () => {
    const page = await sums();
    const size = Math.sqrt(page.length);
    const file = join(outFolder, "chest.nii");
    await server.phrenic("fluoroscopy", "thorax", "--size", String(size), "--out", file);
    const bytes = readFileSync(file);
    const here = new Float32Array(bytes.buffer.slice(bytes.byteOffset + 352, bytes.byteOffset + 352 + 4 * size * size));
    const differences = page.map((each, i) => Math.abs(each - here[i]));
    const mean = (values: ArrayLike<number>) => Array.from(values).reduce((a, b) => a + b, 0) / values.length;
    console.log(`mean ${mean(here).toFixed(3)}, mean difference ${mean(differences).toFixed(5)}`);
    // Positions of the page have an error of up to a millimetre.
    expect(mean(differences)).toBeLessThan(0.01 * mean(here));
    expect(differences.toSorted((a, b) => a - b)[Math.floor(0.99 * differences.length)]).toBeLessThan(0.1);
  });
});

describe("the picture", () => {
  test("IsThatOfAChestRadiograph", async () => {
    const page = await sums();
    const size = Math.sqrt(page.length);
    /** Mean in a square of the picture, of places 0 to 1 from the upper left. */
    const at = (x: number, y: number) => {
      let sum = 0;
      for (let i = -4; i <= 4; i++)
        for (let j = -4; j <= 4; j++) sum += page[Math.round(y * size + i) * size + Math.round(x * size + j)];
      return sum / 81;
    };
    const [rightLung, leftLung, spine, liver] = [at(0.31, 0.5), at(0.72, 0.5), at(0.5, 0.5), at(0.35, 0.8)];
    console.log({ rightLung, leftLung, spine, liver, beside: at(0.02, 0.5) });
    for (const lung of [rightLung, leftLung]) expect(lung).toBeLessThan(0.7 * spine);
    expect(liver).toBeGreaterThan(1.4 * rightLung);
    expect(Math.abs(at(0.02, 0.5))).toBeLessThan(0.02);
    await viewer.saveScreenshot("fluoroscopy");
  });

  test("IsReachedAndTurnedByKeyboardAndHasNoAxeViolations", async () => {
    const { page } = viewer;
    await page.focus("#fluoroscopy-picture");
    await page.keyboard.press("ArrowRight");
    expect(await page.getAttribute("#fluoroscopy-picture", "aria-label")).toContain("LAO 5°");
    await page.keyboard.press("ArrowUp");
    expect(await page.getAttribute("#fluoroscopy-picture", "aria-label")).toContain("cranial 5°");
    await page.click('summary:has-text("What absorbs, and limits")');
    expect(await viewer.violations()).toEqual([]);
    await page.getByRole("button", { name: "Left lateral", exact: true }).click();
    await page.getByText("Bones dark").click();
    expect(await viewer.violations()).toEqual([]);
    await viewer.saveScreenshot("fluoroscopy-lateral");
    await page.focus("#fluoroscopy-picture");
    await page.keyboard.press("Escape");
    expect(await page.locator("#fluoroscopy").count()).toBe(0);
    const drawn = await page.evaluate(() => window.phrenic!.drawCount());
    await page.focus("#view");
    await page.keyboard.press("ArrowLeft");
    await page.waitForFunction((before) => window.phrenic!.drawCount() > before, drawn);
    await page.keyboard.press("x");
    await page.waitForSelector("#fluoroscopy");
    expect(viewer.consoleErrors).toEqual([]);
  });

  test("IsComputedByTheProcessorWhereTheGraphicsCannotAdd", async () => {
    const other = await ViewerPage.open(browser, `${server.url}?session=still`, { width: 900, height: 620 });
    await other.page.evaluate(() => {
      type Get = (this: WebGL2RenderingContext, name: string) => unknown;
      const of = WebGL2RenderingContext.prototype as unknown as { getExtension: Get };
      const known = of.getExtension;
      of.getExtension = function (name) {
        return name.includes("float") ? null : known.call(this, name);
      };
    });
    await open(other);
    expect(await other.page.textContent(".fluoroscopy-controls .fault")).toContain(
      "the processor computes the picture",
    );
    const there = await other.page.evaluate(() => [...window.phrenic!.fluoroscopy()!.sums]);
    expect(there.length).toBe(144 * 144);
    expect(Math.max(...there)).toBeGreaterThan(4);
    expect(other.consoleErrors).toEqual([]);
    await other.close();
  });
});

test("ASniffOfARightPalsyIsParadoxicalInWords", async () => {
  await server.phrenic("create", "thorax", "--id", "palsy", "--preset", "palsy-right", "--play");
  const student = await ViewerPage.open(browser, `${server.url}?session=palsy&view=student`, {
    width: 390,
    height: 780,
  });
  const { page } = student;
  await open(student);
  await page.click("#sniff-run");
  await page.waitForFunction(() => /dome \d/.test(document.querySelector("#sniff-result")!.textContent!), null, { timeout: 90_000 }); // prettier-ignore
  const words = (await page.textContent("#sniff-result"))!;
  console.log(words);
  const [, right, left] = /Right dome (\d+) mm up, left dome (\d+) mm down/.exec(words) ?? [];
  expect(Number(right)).toBeGreaterThan(5);
  expect(Number(left)).toBeGreaterThan(10);
  expect(words).toContain("The right dome rises while the left dome falls: paradoxical");
  // The next drawing marks them.
  await expect.poll(() => page.locator(".fluoroscopy-marks .excursion").count()).toBe(2);
  expect(await student.violations()).toEqual([]);
  await student.saveScreenshot("fluoroscopy-phone");
  const parameters = async () => {
    const { sessions } = JSON.parse(await server.phrenic("sessions", "-o", "json"));
    return sessions.find(({ id }: { id: string }) => id === "palsy").parameters;
  };
  expect(await parameters()).toMatchObject({ breath_length: 6, right_activation: 0 });
  await page.click("#sniff-back");
  await expect.poll(async () => (await parameters()).breath_length).toBe(4);
  expect(student.consoleErrors).toEqual([]);
  await student.close();
});
