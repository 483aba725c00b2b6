import { mkdtempSync, rmSync, writeFileSync } from "node:fs";
import { tmpdir } from "node:os";
import { join } from "node:path";
import type { Browser } from "playwright-core";
import { afterAll, beforeAll, expect, test } from "vitest";
import { launchBrowser, ViewerPage } from "./browser";
import { Server } from "./server";

const folder = mkdtempSync(join(tmpdir(), "phrenic-accounts-"));
const accounts = join(folder, "accounts");
let anna: string;
let server: Server;
let browser: Browser;

beforeAll(async () => {
  anna = await Server.addAccount(accounts, "anna", "owner");
  writeFileSync(join(folder, "anna"), anna);
  server = await Server.start("cube-springs", ["--tokens", accounts]);
  browser = await launchBrowser();
});

afterAll(async () => {
  await browser?.close();
  await server?.end();
  rmSync(folder, { recursive: true });
});

test("the page asks for a token and shows the session after sign-in", async () => {
  const page = await (await browser.newContext()).newPage();
  const complaints: string[] = [];
  page.on("console", (message) => {
    if (message.text().includes("Content Security Policy")) complaints.push(message.text());
  });
  await page.goto(server.url);
  const sign = async (token: string) => {
    await page.fill("#sign-in input", token);
    await page.click("#sign-in button");
  };
  await sign("00112233445566778899aabbccddeeff");
  await page.waitForSelector("text=No account has this token");
  await sign(anna);
  await page.waitForFunction(() => (window.phrenic?.drawCount() ?? 0) > 1, null, { timeout: 60_000 });
  expect(page.url()).not.toContain(anna);
  expect(complaints).toEqual([]);
  await page.context().close();
});

test("a join link opens its session without an account, and its secret is removed from the address", async () => {
  const token = ["--token-file", join(folder, "anna")];
  await server.phrenic(...token, "create", "cube-tensegrity", "--id", "mine", "--play");
  const { secret } = JSON.parse(await server.phrenic(...token, "link", "create", "mine", "-o", "json"));
  const viewer = await ViewerPage.open(browser, `${server.url}?session=mine#join=${secret}`);
  expect(viewer.page.url()).not.toContain(secret);
  await viewer.close();
});
