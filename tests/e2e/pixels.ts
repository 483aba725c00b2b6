import type { Browser, Page } from "playwright-core";
import { ColorScale } from "../../web/src/appearance/color_scale";
import type { ViewerPage } from "./browser";

/** Returns a screenshot of the canvas as PNG in base64. */
export async function canvasPicture(viewer: ViewerPage): Promise<string> {
  const png = await viewer.page.screenshot({ clip: await middle(viewer.page) });
  return png.toString("base64");
}

/** Returns the central part of the canvas that no panel covers. */
async function middle(page: Page) {
  const box = await page.locator("#view").boundingBox();
  if (box === null) throw new Error("The canvas is not on the page.");
  return { x: box.x + 40, y: box.y + 60, width: box.width - 80, height: box.height - 190 };
}

/** Returns the fraction of pixels, 0 to 1, that differ by more than 16 of 255 in a colour channel. */
export async function changedFraction(browser: Browser, a: string, b: string): Promise<number> {
  const page = await browser.newPage();
  const share = await page.evaluate(
    async (pictures) => {
      const [first, second] = await Promise.all(
        pictures.map(async (base64) => {
          const image = new Image();
          image.src = `data:image/png;base64,${base64}`;
          await image.decode();
          const pen = new OffscreenCanvas(image.width, image.height).getContext("2d")!;
          pen.drawImage(image, 0, 0);
          return pen.getImageData(0, 0, image.width, image.height).data;
        }),
      );
      let changed = 0;
      for (let i = 0; i < first.length; i += 4) {
        if ([0, 1, 2].some((k) => Math.abs(first[i + k] - second[i + k]) > 16)) changed++;
      }
      return changed / (first.length / 4);
    },
    [a, b],
  );
  await page.close();
  return share;
}

/** Pixels of the model: where they are on the page [CSS pixels], and their colours. */
interface ModelPixels {
  box: { x: number; y: number; width: number; height: number };
  /** Red, green and blue, 0 to 255, of each. */
  colors: number[];
}

/** Returns the pixels of the canvas that the model covers: a screenshot before blue, without panels. */
async function modelPixels({ page }: ViewerPage): Promise<ModelPixels> {
  const area = (await page.locator("#view").boundingBox())!;
  await setBare(page, true);
  const png = (await page.screenshot({ clip: area })).toString("base64");
  await setBare(page, false);
  const { box, colors } = await page.evaluate(async (base64) => {
    const bytes = Uint8Array.from(atob(base64), (letter) => letter.charCodeAt(0));
    const image = await createImageBitmap(new Blob([bytes], { type: "image/png" }));
    const { width, height } = image;
    const pen = new OffscreenCanvas(width, height).getContext("2d")!;
    pen.drawImage(image, 0, 0);
    const { data } = pen.getImageData(0, 0, width, height);
    const colors: number[] = [];
    let [left, top, right, bottom] = [width, height, 0, 0];
    for (let i = 0; i < data.length; i += 4) {
      if (data[i] + data[i + 1] < 24 && data[i + 2] > 230) continue;
      const [x, y] = [(i / 4) % width, Math.floor(i / 4 / width)];
      [left, right] = [Math.min(left, x), Math.max(right, x)];
      [top, bottom] = [Math.min(top, y), Math.max(bottom, y)];
      colors.push(data[i], data[i + 1], data[i + 2]);
    }
    return { box: { x: left, y: top, width: right - left + 1, height: bottom - top + 1 }, colors };
  }, png);
  return { box: { ...box, x: box.x + area.x, y: box.y + area.y }, colors };
}

/** Returns the smallest box around the model on the page [CSS pixels]. */
export async function modelBox(viewer: ViewerPage): Promise<ModelPixels["box"]> {
  return (await modelPixels(viewer)).box;
}

/** Returns the fraction of the model's pixels, 0 to 1, whose colour is one of the scale from 0, to 3 of 255. */
export async function exactShare(viewer: ViewerPage): Promise<number> {
  const scale = new ColorScale(1);
  const known = Array.from({ length: 256 }, (_, i) => scale.color(i / 255));
  const { colors } = await modelPixels(viewer);
  let exact = 0;
  for (let i = 0; i < colors.length; i += 3)
    if (known.some((color) => color.every((part, k) => Math.abs(part - colors[i + k]) <= 3))) exact++;
  return exact / (colors.length / 3);
}

/** Hides what lies over the canvas and makes its background blue, or restores both. */
function setBare(page: Page, bare: boolean): Promise<void> {
  return page.evaluate((on) => {
    document.getElementById("stage")!.style.background = on ? "#00f" : "";
    for (const each of document.querySelectorAll<HTMLElement>("#stage > :not(canvas)"))
      each.style.visibility = on ? "hidden" : "";
  }, bare);
}
