import type { Browser, Page } from "playwright-core";
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
