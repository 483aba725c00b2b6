import { execFile } from "node:child_process";
import { statSync } from "node:fs";
import { readFile, writeFile } from "node:fs/promises";
import { join } from "node:path";
import { pathToFileURL } from "node:url";
import { promisify } from "node:util";
import type { Browser, Page } from "playwright-core";
import { afterAll, beforeAll, expect, test } from "vitest";
import { filmRate, leastCaption } from "../../web/src/film/layout";
import { endAll, isComplaint, slowDisplay, startAll, ViewerPage } from "./browser";
import { outFolder, type Server } from "./server";

let server: Server;
let browser: Browser;

/**
 * Of a breath [s]: a short one, since a second of a film has 25 pictures, each of which takes the processor a second.
 */
const breathLength = 0.8;

beforeAll(async () => {
  [browser, server] = await startAll();
  await server.phrenic("set", "thorax", `breath_length=${breathLength}`);
  // The server then records the breath with the whole machine; the session itself may rest.
  await server.phrenic("pause", "thorax");
});

afterAll(() => endAll(browser, server));

/**
 * Plays a film of 360 lines in a page of its own: its size, duration [s], and pictures at some times, in the middle of
 * those of the film, as data URLs.
 */
async function watch(page: Page, bytes: Buffer, times: number[]) {
  return page.evaluate(
    async ([text, moments, rate, caption]) => {
      const video = document.createElement("video");
      video.src = `data:video/webm;base64,${text}`;
      await new Promise((done, fail) => ((video.onloadeddata = done), (video.onerror = fail)));
      const canvas = Object.assign(document.createElement("canvas"), { width: video.videoWidth, height: video.videoHeight }); // prettier-ignore
      const pen = canvas.getContext("2d")!;
      const pictures: string[] = [];
      let [before, moved, bright] = [undefined as Uint8ClampedArray | undefined, [] as number[], 0];
      for (const time of moments) {
        // A video that has been sought may still show the picture before: the one of this moment must be presented.
        const presented = new Promise<void>((done) => {
          const look = (_: number, { mediaTime }: VideoFrameCallbackMetadata) =>
            mediaTime <= time && time < mediaTime + 1 / rate ? done() : video.requestVideoFrameCallback(look);
          video.requestVideoFrameCallback(look);
        });
        video.currentTime = time;
        await presented;
        pen.drawImage(video, 0, 0);
        // The caption's clock changes in any case: only the picture above it counts.
        const { data } = pen.getImageData(0, 0, canvas.width, canvas.height - caption);
        let count = 0;
        for (let i = 0; i < data.length; i += 4) {
          if (before !== undefined && Math.abs(data[i] - before[i]) > 24) count++;
          if (data[i] > 120) bright++;
        }
        if (before !== undefined) moved.push(count / (data.length / 4));
        before = data;
        pictures.push(canvas.toDataURL("image/png").split(",")[1]);
      }
      const part = bright / (moments.length * canvas.width * canvas.height);
      return { width: canvas.width, height: canvas.height, duration: video.duration, moved, bright: part, pictures };
    },
    [bytes.toString("base64"), times, filmRate, leastCaption] as const,
  );
}

/** Stops the film, which may take only a second, once its progress has these words. */
async function stopFilm(page: Page, words: string): Promise<void> {
  const stopped = (awaited: string) => {
    const progress = document.getElementById("film-progress")!;
    if (progress.textContent?.includes(awaited) !== true) return false;
    progress.querySelector("button")!.click();
    return true;
  };
  await page.waitForFunction(stopped, words, { timeout: 60_000 });
  await page.waitForFunction(() => !(document.getElementById("film") as HTMLButtonElement).disabled);
  expect(await page.textContent("#film-progress")).toBe("");
}

test("AFilmOfABreathPlays", { timeout: 240_000 }, async () => {
  const viewer = await ViewerPage.open(browser, server.url);
  const { page } = viewer;
  await page.locator("#coloring-kind").selectOption("displacement", { force: true });
  await page.click("#share-open");
  // Only a visible button takes the focus.
  await page.locator("#film").waitFor();
  await page.selectOption("#film-lines", "360");
  await page.focus("#film");
  const started = Date.now();
  const saving = page.waitForEvent("download", { timeout: 200_000 });
  await page.keyboard.press("Enter");
  const shown = () => page.textContent("#film-progress");
  await expect.poll(shown, { timeout: 100_000 }).toContain("Drawing the film");
  const recorded = (Date.now() - started) / 1000;
  expect(await page.evaluate(() => document.activeElement?.textContent)).toBe("Stop");
  expect(await viewer.violations()).toEqual([]);
  const file = await saving;
  const seconds = (Date.now() - started) / 1000;
  expect(file.suggestedFilename()).toBe("thorax.webm");
  const path = join(outFolder, "breath.webm");
  await file.saveAs(path);
  const empty = await (await browser.newContext()).newPage();
  const film = await watch(empty, await readFile(path), [0.02, 0.22, 0.42]);
  for (const [i, each] of film.pictures.entries()) await writeFile(join(outFolder, `film-${i}.png`), each, "base64");
  console.log(
    `film: ${film.width} x ${film.height}, ${film.duration.toFixed(2)} s, ${(statSync(path).size / 1e6).toFixed(2)} MB, recorded in ${recorded.toFixed(0)} s, drawn by ${seconds.toFixed(0)} s; moved ${film.moved.map((each) => each.toFixed(3)).join(" ")}`,
  );
  expect([film.width % 2, film.height % 2]).toEqual([0, 0]);
  expect(film.width === 640 || film.height === 360).toBe(true);
  expect(Math.abs(film.duration - breathLength)).toBeLessThan(0.2);
  expect(film.bright).toBeGreaterThan(0.02);
  for (const part of film.moved) expect(part).toBeGreaterThan(0.001);
  // The view is live again, and a second film can be cancelled.
  await page.keyboard.press("Escape");
  await server.phrenic("play", "thorax");
  await viewer.waitForTick(await viewer.tick());
  const count = await page.evaluate(() => window.phrenic!.drawCount());
  await page.waitForFunction((before) => window.phrenic!.drawCount() > before, count);
  await server.phrenic("pause", "thorax");
  await page.click("#share-open");
  await page.click("#film");
  await stopFilm(page, "Recording");
  expect(viewer.consoleErrors).toEqual([]);
  await Promise.all([empty.context().close(), viewer.close()]);
});

test("APageThatWasTakenHomeMakesAFilmWithoutANetwork", { timeout: 240_000 }, async () => {
  const path = join(outFolder, "film-page.html");
  await server.phrenic("export", "thorax", path);
  const context = await browser.newContext({ viewport: { width: 900, height: 620 }, offline: true });
  await slowDisplay(context);
  const page = await context.newPage();
  const complaints: string[] = [];
  page.on("console", (message) => isComplaint(message) && complaints.push(message.text()));
  page.on("pageerror", (error) => complaints.push(String(error)));
  await page.goto(pathToFileURL(path).href);
  await page.waitForSelector("#loading", { state: "hidden", timeout: 30_000 });
  await page.locator("summary", { hasText: "A film of this breath" }).click();
  await page.selectOption("#film-lines", "360");
  const [file] = await Promise.all([page.waitForEvent("download", { timeout: 100_000 }), page.click("#film")]);
  const film = await watch(await context.newPage(), await readFile((await file.path())!), [0.02, 0.42]);
  expect(Math.abs(film.duration - breathLength)).toBeLessThan(0.2);
  expect(film.moved[0]).toBeGreaterThan(0.001);
  await page.click("#film");
  await stopFilm(page, "Drawing the film");
  const [picture] = await Promise.all([page.waitForEvent("download", { timeout: 100_000 }), page.click("#animation")]);
  expect(picture.suggestedFilename()).toBe("thorax.png");
  const animation = join(outFolder, "breath.png");
  await picture.saveAs(animation);
  const { frames, seconds, size, moved } = await readAnimation(animation);
  const megabytes = statSync(animation).size / 1e6;
  console.log(`animated picture: ${size.join(" x ")}, ${frames} frames, ${seconds} s, ${megabytes.toFixed(2)} MB`);
  expect(frames).toBe(Math.round(10 * breathLength));
  expect(Math.abs(seconds - breathLength)).toBeLessThan(0.11);
  expect(Math.max(...size)).toBeLessThanOrEqual(480);
  expect(moved).toBe(true);
  expect(complaints).toEqual([]);
  await context.close();
});

const pillow = `
import json, sys
from PIL import Image, ImageChops
picture = Image.open(sys.argv[1])
shown = []
for i in range(picture.n_frames):
    picture.seek(i)
    shown.append((picture.info["duration"], picture.convert("RGB")))
moved = ImageChops.difference(shown[0][1], shown[len(shown) // 2][1]).getbbox() is not None
print(json.dumps(dict(frames=len(shown), seconds=sum(each for each, _ in shown) / 1000, size=picture.size, moved=moved)))
`;

/** Reads an animated picture by Pillow (Debian's python3-pil). */
async function readAnimation(path: string) {
  const { stdout } = await promisify(execFile)("/usr/bin/python3", ["-c", pillow, path]);
  return JSON.parse(stdout) as { frames: number; seconds: number; size: number[]; moved: boolean };
}

/** Returns the number of pages of a PDF file. */
function pageCount(pdf: Buffer): number {
  return pdf.toString("latin1").match(/\/Type\s*\/Page\b(?!s)/g)?.length ?? 0;
}

test("ALessonIsPrintedAsAWorksheet", async () => {
  const viewer = await ViewerPage.open(browser, `${server.url}?session=thorax&lesson=how-we-breathe&step=1`);
  const { page } = viewer;
  await page.evaluate(() => (window.print = () => document.body.setAttribute("data-printed", "")));
  await page.waitForTimeout(1500);
  await page.click("#lesson-next");
  await page.getByRole("heading", { name: "The diaphragm pulls" }).waitFor();
  await page.waitForTimeout(1500);
  await page.focus("#lesson-print");
  await page.keyboard.press("Enter");
  await page.waitForSelector("#worksheet");
  expect(await page.evaluate(() => document.activeElement?.id)).toBe("worksheet-print");
  expect(await viewer.violations()).toEqual([]);
  await viewer.saveScreenshot("worksheet-screen");
  expect(await page.locator("#worksheet img").count()).toBe(2);
  await page.press("#worksheet-print", "Enter");
  await page.waitForSelector("body[data-printed]");
  const pupil = await page.pdf({ preferCSSPageSize: true, path: join(outFolder, "worksheet.pdf") });
  await page.getByLabel("Answers for the teacher").check();
  const teacher = await page.pdf({ preferCSSPageSize: true, path: join(outFolder, "worksheet-answers.pdf") });
  const pages = pageCount(pupil);
  console.log(`worksheet: ${pages} pages, with answers ${pageCount(teacher)}`);
  // Five steps, two with a picture and three without; the answers begin on a page of their own.
  expect(pages).toBe(2);
  expect(pageCount(teacher)).toBe(pages + 1);
  expect(pupil.toString("latin1")).toMatch(/\/MediaBox\s*\[0 0 59[45][.\d]* 84[12]/);
  await page.keyboard.press("Escape");
  expect(await page.evaluate(() => document.activeElement?.id)).toBe("lesson-print");
  expect(await page.locator("#worksheet").count()).toBe(0);
  expect(await viewer.violations()).toEqual([]);
  expect(viewer.consoleErrors).toEqual([]);
  await viewer.close();
});
