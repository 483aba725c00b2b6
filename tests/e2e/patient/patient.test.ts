import { execFile } from "node:child_process";
import { existsSync } from "node:fs";
import { readFile } from "node:fs/promises";
import { join } from "node:path";
import { promisify } from "node:util";
import type { Browser } from "playwright-core";
import { afterAll, beforeAll, expect, test } from "vitest";
import { endAll, startAll, ViewerPage } from "../browser";
import { outFolder, type Server } from "../server";

const root = join(import.meta.dirname, "../../..");
const slab = join(root, "../shared/data/labels/totalsegmentator_example_seg.nii.gz");
/** Loaded machines make a patient of 20,000 vertices in minutes. */
const patience = { timeout: 240_000 };

let server: Server;
let browser: Browser;

beforeAll(async () => {
  [browser, server] = await startAll("none");
  await server.phrenic("create", "cube-springs", "--id", "cube");
});

afterAll(() => endAll(browser, server));

/** Drops files on the page, as from the desktop: their paths by the names that they have there. */
async function drop({ page }: ViewerPage, files: Record<string, string>): Promise<void> {
  const contents: [string, string][] = [];
  for (const [name, path] of Object.entries(files)) contents.push([name, (await readFile(path)).toString("base64")]);
  await page.evaluate((dropped) => {
    const dataTransfer = new DataTransfer();
    for (const [name, text] of dropped) {
      const bytes = Uint8Array.from(atob(text), (each) => each.charCodeAt(0));
      dataTransfer.items.add(new File([bytes], name));
    }
    document.body.dispatchEvent(new DragEvent("drop", { dataTransfer, bubbles: true, cancelable: true }));
  }, contents);
}

/** Makes a DICOM Segmentation of a phantom with pydicom. */
async function writeSegmentation(): Promise<string> {
  const [nifti, dicom] = ["nii.gz", "dcm"].map((ending) => join(outFolder, `phantom.${ending}`));
  await server.phrenic("phantom", "--voxel", "3", "--out", nifti);
  await promisify(execFile)("/usr/bin/python3", [join(root, "tests/imaging/write_segmentation.py"), nifti, dicom]);
  return dicom;
}

test("ADroppedDicomSegmentationBecomesABreathingPatient", async () => {
  const dicom = await writeSegmentation();
  const viewer = await ViewerPage.open(browser, `${server.url}?session=cube`, { width: 1280, height: 900 });
  await viewer.waitForPicture();
  const begun = Date.now();
  const seconds = () => ((Date.now() - begun) / 1000).toFixed(0);
  await drop(viewer, { "DOE^JANE 1948.dcm": dicom });
  const { page } = viewer;
  await page.waitForSelector("#patient-make", patience);
  console.log(`the labels are shown after ${seconds()} s`);
  const rows = await page.locator(".label-rows tbody tr").count();
  expect(rows).toBeGreaterThan(30);
  expect(await page.locator('.label-rows select:has(option:checked[value=""])').count()).toBe(0);
  expect(await viewer.violations()).toEqual([]);
  await viewer.saveScreenshot("patient_labels");
  await page.click("#patient-make");
  await page.waitForSelector("#patient-verdict", patience);
  console.log(`the patient is made after ${seconds()} s`);
  expect(await page.locator("#patient-verdict").getAttribute("data-verdict")).not.toBe("NOT_USABLE");
  await viewer.saveScreenshot("patient_verdict");
  await page.click("#patient-open");
  await page.waitForURL(({ search }) => !search.startsWith("?session=cube"), patience);
  await viewer.waitForPicture();
  const before = await viewer.sample("diaphragm", 100);
  await viewer.waitForTick(before.tick + 20);
  await expect.poll(async () => (await viewer.sample("diaphragm", 100)).points, patience).not.toEqual(before.points);
  console.log(`the patient breathes after ${seconds()} s`);
  await viewer.saveScreenshot("patient_breathes");
  expect(await page.content()).not.toMatch(/DOE|Doe/);
  expect(page.url()).not.toMatch(/DOE|Doe/i);
  expect(viewer.consoleErrors).toEqual([]);
  await viewer.close();
  expect(await readFile(join(outFolder, "phrenicd.log"), "utf8")).not.toMatch(/DOE\^JANE|Doe\^Jane/);
}, 400_000);

// Without ribs, which are filled from the generated thorax, and in a file for each model, as MOOSE writes them.
test("FilesOfOnePatientAreOneAndWhatIsFilledHasAColour", async () => {
  const files: Record<string, string> = {};
  for (const model of ["vertebrae", "organs", "cardiac"]) {
    const path = join(outFolder, `${model}.nii.gz`);
    await server.phrenic("phantom", "--voxel", "4", "--labels", `moose-${model}`, "--out", path);
    files[`DOE^JANE_CT_${model}_0000.nii.gz`] = path;
  }
  const viewer = await ViewerPage.open(browser, `${server.url}?session=cube&lang=es`, { width: 1280, height: 900 });
  await viewer.waitForPicture();
  await drop(viewer, files);
  const { page } = viewer;
  await page.click("#patient-all", patience);
  await page.waitForSelector("#patient-make", patience);
  expect(await page.locator(".label-rows tbody tr").count()).toBeGreaterThan(15);
  expect(await viewer.violations()).toEqual([]);
  await viewer.saveScreenshot("patient_files");
  await page.click("#patient-make");
  await page.waitForSelector("#patient-verdict", patience);
  await viewer.saveScreenshot("patient_files_verdict");
  expect(await page.locator("#patient-verdict").getAttribute("data-verdict")).toBe("USABLE_WITH_CARE");
  await page.click("#patient-open");
  await page.waitForURL(({ search }) => !search.startsWith("?session=cube"), patience);
  await viewer.waitForPicture();
  await page.waitForSelector("#template-legend:visible", patience);
  await viewer.saveScreenshot("patient_filled");
  expect(await page.content()).not.toMatch(/DOE|Doe/);
  await viewer.close();
  expect(await readFile(join(outFolder, "phrenicd.log"), "utf8")).not.toMatch(/DOE\^JANE/);
}, 400_000);

test.runIf(existsSync(slab))(
  "ASlabIsRefusedWithItsReasons",
  async () => {
    const viewer = await ViewerPage.open(browser, `${server.url}?session=cube&lang=de`, { width: 1280, height: 900 });
    await viewer.waitForPicture();
    await drop(viewer, { "slab.nii.gz": slab });
    const { page } = viewer;
    await page.click("#patient-make", patience);
    await page.waitForSelector("#patient-verdict", patience);
    expect(await page.locator("#patient-verdict").getAttribute("data-verdict")).toBe("NOT_USABLE");
    expect(await page.locator("#patient-verdict").textContent()).toMatch(/^Nicht brauchbar/);
    expect(await page.locator("#patient-reasons li").count()).toBeGreaterThan(2);
    expect(await page.locator("#patient-reasons").textContent()).toMatch(/abgeschnitten|schneidet ab/);
    expect(await page.locator("#patient-reasons").textContent()).not.toMatch(/\bribs?\b|border|--/);
    expect(await page.locator("#patient-open").count()).toBe(0);
    await viewer.saveScreenshot("patient_refused");
    await page.click("#patient-cancel");
    await page.waitForSelector("#patient-file");
    expect(viewer.consoleErrors).toEqual([]);
    await viewer.close();
  },
  300_000,
);
