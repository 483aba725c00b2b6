import { readFileSync } from "node:fs";
import { join } from "node:path";
import { setTimeout as sleep } from "node:timers/promises";
import type { Browser, Page } from "playwright-core";
import { ViewerPage } from "./browser";
import type { Server } from "./server";

/** A column of the sheet: a preset at the end of an inspiration, from the front and from the left. */
interface Column {
  preset: string;
  title: string;
  /** Simulated time [s]. */
  time: number;
  /** True if the front half and the left half are cut away. */
  cut?: boolean;
}

/** Ends of inspiration once the breath repeats; lungs with trapped air need some breaths for it. */
const columns: Column[] = [
  { preset: "quiet", title: "Quiet, supine", time: 6.05 },
  { preset: "deep", title: "Deep breath", time: 9.1 },
  { preset: "deep", title: "Deep breath, cut", time: 9.1, cut: true },
  { preset: "sniff", title: "Sniff", time: 6.45 },
  { preset: "palsy-right", title: "Right palsy", time: 6.05 },
  { preset: "copd", title: "COPD", time: 12.3 },
  { preset: "pneumothorax-right", title: "Right pneumothorax", time: 6.05 },
  { preset: "ventilator", title: "Ventilator, 10 cmH₂O", time: 6.05 },
];
/**
 * Both views, and where their planes cut, as a fraction of the scene: through both domes, and through the right one.
 */
const views = [
  { side: "front", plane: "coronal", position: 0.5 },
  { side: "left", plane: "sagittal", position: 0.28 },
];

/** Part of the page that shows the thorax [CSS pixels]. */
const size = { width: 760, height: 760 };
const clip = { x: 187, y: 88, width: 386, height: 560 };

/** Writes a picture of the presets of `thorax`, with the resting position as a ghost. */
export async function contactSheet(browser: Browser, server: Server, path: string): Promise<void> {
  const tiles: string[] = [];
  for (const [i, column] of columns.entries()) tiles.push(await columnOf(browser, server, column, `session-${i}`));
  await writeSheet(browser, tiles, columns.length, path, 82);
}

/** A body of client/examples/bodies.txt: a title, and numbers "name=value". */
interface NamedBody {
  title: string;
  numbers: string[];
}

function namedBodies(): NamedBody[] {
  const lines = readFileSync(join(import.meta.dirname, "../../client/examples/bodies.txt"), "utf8").split("\n");
  return lines
    .filter((line) => line.includes(":") && !line.startsWith("#"))
    .map((line) => {
      const colon = line.indexOf(":");
      return {
        title: line.slice(0, colon),
        numbers: line
          .slice(colon + 1)
          .split(" ")
          .filter(Boolean),
      };
    });
}

/** Writes a picture of the bodies at rest, from the front and from the left, at one scale. */
export async function bodySheet(browser: Browser, server: Server, path: string): Promise<void> {
  const tiles: string[] = [];
  const bodies = namedBodies();
  let adult: number | undefined;
  for (const [i, body] of bodies.entries()) {
    const { pictures, distance } = await picturesOf(browser, server, body, `body-${i}`);
    adult ??= distance;
    // The viewer fits each body into the window: its distance is the scale.
    const scale = (tileWidth / clip.width) * (distance / adult);
    const images = pictures.map((picture) => `<div class="tile">${image(picture, size.width * scale)}</div>`);
    tiles.push(`<figure><figcaption>${body.title}</figcaption>${images.join("")}</figure>`);
  }
  await writeSheet(browser, tiles, bodies.length / 2, path, 75);
}

const tileWidth = 190;

/** Returns the pictures of a body, and the distance from which they are taken [m]. */
async function picturesOf(browser: Browser, server: Server, { numbers }: NamedBody, id: string) {
  await server.phrenic("create", "thorax", "--id", id, ...numbers.flatMap((number) => ["--physique", number]));
  const viewer = await ViewerPage.open(browser, `${server.url}?session=${id}`, size);
  const { page } = viewer;
  await hideControls(page);
  await page.evaluate(() => {
    document.body.style.visibility = "hidden";
    document.querySelector<HTMLElement>("#stage > canvas")!.style.visibility = "visible";
  });
  await choose(page, "quality", "full");
  const pictures: Buffer[] = [];
  const eyes: [number, number, number][] = [];
  for (const { side } of views) {
    await click(page, `[data-view="${side}"]`);
    await page.waitForTimeout(3000);
    eyes.push(await page.evaluate(() => window.phrenic!.eye()));
    pictures.push(await page.screenshot({ type: "png" }));
  }
  await viewer.close();
  await server.phrenic("delete", id);
  return { pictures, distance: eyes[1][0] - eyes[0][0] }; // from the left and from the front, around one centre
}

function image(picture: Buffer, width: number): string {
  return `<img style="width: ${width}px" src="data:image/png;base64,${picture.toString("base64")}">`;
}

async function writeSheet(browser: Browser, tiles: string[], across: number, path: string, quality: number) {
  const page = await browser.newPage({ viewport: { width: tileWidth * across, height: 600 } });
  const style = `body { margin: 0; background: #171c22; color: #e8eaed; font: 14px sans-serif; display: flex; flex-wrap: wrap }
    figure { margin: 0; width: ${tileWidth}px } figcaption { padding: 8px 0 4px; text-align: center }
    .tile { height: 285px; overflow: hidden; display: flex; align-items: center; justify-content: center }
    .tile > img { flex: none }
    img { display: block; width: ${tileWidth}px }`;
  await page.setContent(`<style>${style}</style>${tiles.join("")}`);
  await page.locator("body").screenshot({ path, type: "jpeg", quality });
  await page.close();
}

async function columnOf(browser: Browser, server: Server, { preset, title, time, cut }: Column, id: string) {
  await server.phrenic("create", "thorax", "--id", id, "--preset", preset);
  await server.phrenic("play", id, "--fast", "--until", String(time));
  while (await isPlaying(server, id)) await sleep(200);
  const viewer = await ViewerPage.open(browser, `${server.url}?session=${id}`, size);
  const { page } = viewer;
  await hideControls(page);
  await choose(page, "quality", "full");
  await choose(page, "ghost", "rest");
  const pictures: string[] = [];
  for (const { side, plane, position } of views) {
    if (cut) await cutAt(page, plane, position);
    await click(page, `[data-view="${side}"]`);
    await page.waitForTimeout(3000); // The canvas is drawn at full resolution when nothing moves.
    pictures.push(image(await page.screenshot({ clip, type: "png" }), tileWidth));
  }
  await viewer.close();
  await server.phrenic("delete", id);
  return `<figure><figcaption>${title}</figcaption>${pictures.join("")}</figure>`;
}

function hideControls(page: Page): Promise<void> {
  return page.evaluate(() => {
    for (const each of document.querySelectorAll<HTMLElement>("#stage > :not(canvas)"))
      each.style.visibility = "hidden";
  });
}

async function isPlaying(server: Server, wanted: string): Promise<boolean> {
  const { sessions } = JSON.parse(await server.phrenic("sessions", "-o", "json"));
  return sessions.some(({ id, state }: { id: string; state: string }) => id === wanted && state.endsWith("_PLAYING"));
}

/** Cuts away what is in front of the plane. */
async function cutAt(page: Page, plane: string, position: number): Promise<void> {
  await choose(page, "cut", plane);
  await choose(page, "cut-position", String(position));
  if (plane === "sagittal") await click(page, "#cut-flip");
}

/** Sets a control of the panel, which is folded away in a small window. */
function choose(page: Page, id: string, value: string): Promise<void> {
  return page.evaluate(
    ([name, chosen]) => {
      const control = document.getElementById(name) as HTMLSelectElement | HTMLInputElement;
      control.value = chosen;
      control.dispatchEvent(new Event("input"));
      control.dispatchEvent(new Event("change"));
    },
    [id, value],
  );
}

function click(page: Page, selector: string): Promise<void> {
  return page.evaluate((place) => document.querySelector<HTMLElement>(place)!.click(), selector);
}
