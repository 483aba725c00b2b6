import axe from "axe-core";
import { existsSync, mkdirSync } from "node:fs";
import { join } from "node:path";
import { type Browser, type BrowserContext, chromium, type ConsoleMessage, type Page } from "playwright-core";
import type { TestHook } from "../../web/src/app/test_hook";
import { outFolder, Server } from "./server";

declare global {
  interface Window {
    phrenic?: TestHook;
  }
}

const chromiumPaths = ["/usr/bin/chromium", "/usr/bin/chromium-browser", "/usr/bin/google-chrome"];

/**
 * Starts headless Chromium with a new profile, as on a machine without a graphics card: the processor draws and
 * composes.
 */
export async function launchBrowser(): Promise<Browser> {
  const executablePath = [process.env.PHRENIC_CHROMIUM ?? "", ...chromiumPaths].find(
    (path) => path !== "" && existsSync(path),
  );
  if (executablePath === undefined) {
    throw new Error("There is no Chromium: install Debian's package chromium, or set PHRENIC_CHROMIUM to a browser.");
  }
  return chromium.launch({
    executablePath,
    headless: true,
    args: [
      "--no-sandbox",
      "--disable-quic",
      "--no-first-run",
      "--disable-background-networking",
      "--disable-component-update",
      "--disable-sync",
      "--enable-unsafe-swiftshader",
    ],
  });
}

/**
 * True for an error or a warning of the page. Chromium itself warns of reading the picture back, where the processor
 * composes.
 */
export function isComplaint(message: ConsoleMessage): boolean {
  return ["error", "warning"].includes(message.type()) && !message.text().includes("GPU stall due to ReadPixels");
}

/** Starts a browser and a server with a playing session of `scene`; "none" for no session. */
export async function startAll(scene = "thorax"): Promise<[Browser, Server]> {
  mkdirSync(outFolder, { recursive: true });
  return [await launchBrowser(), await Server.start(scene)];
}

/** Closes what `startAll` started, also if it failed. */
export async function endAll(browser: Browser | undefined, server: Server | undefined): Promise<void> {
  await browser?.close();
  await server?.end();
}

/**
 * Draws the pages of `context` at most eight times a second, whatever the machine could: tests look at what is drawn,
 * and without a graphics card each drawing takes a core for 50 ms, which the simulation and the other browsers need.
 */
export async function slowDisplay(context: BrowserContext): Promise<void> {
  await context.addInitScript(() => {
    const native = window.requestAnimationFrame.bind(window);
    window.requestAnimationFrame = (draw) => window.setTimeout(() => native(draw), 110);
    window.cancelAnimationFrame = (id) => clearTimeout(id);
  });
}

/** A page with the viewer, and the console errors and requests that it causes. */
export class ViewerPage {
  readonly consoleErrors: string[] = [];
  readonly origins = new Set<string>();

  private constructor(readonly page: Page) {
    page.on("console", (message) => isComplaint(message) && this.consoleErrors.push(message.text()));
    page.on("pageerror", (error) => this.consoleErrors.push(String(error)));
    page.on("request", (request) => this.origins.add(new URL(request.url()).origin));
  }

  /** Opens the viewer in a new browser context and waits until a frame is drawn. */
  static async open(
    browser: Browser,
    url: string,
    size = { width: 900, height: 620 },
    colorScheme: "dark" | "light" = "dark",
  ): Promise<ViewerPage> {
    const context = await browser.newContext({ viewport: size, colorScheme });
    await slowDisplay(context);
    const viewer = new ViewerPage(await context.newPage());
    await viewer.page.goto(url);
    await viewer.waitForPicture();
    return viewer;
  }

  /** Waits until a frame is drawn. */
  async waitForPicture(): Promise<void> {
    const drawn = () => (window.phrenic?.tick() ?? -1) >= 0 && (window.phrenic?.drawCount() ?? 0) > 1;
    await this.page.waitForFunction(drawn, null, { timeout: 60_000 });
  }

  /** Returns the tick of the newest frame. */
  tick(): Promise<number> {
    return this.page.evaluate(() => window.phrenic!.tick());
  }

  /**
   * Returns every `stride`-th vertex of a body in the newest frame [m] and its tick, once a frame of the body is
   * decoded.
   */
  async sample(body: string, stride = 200): Promise<{ tick: number; points: [number, number, number][] }> {
    const decoded = (name: string) => {
      try {
        return window.phrenic!.vertex(name, 0).length === 3;
      } catch {
        return false;
      }
    };
    await this.page.waitForFunction(decoded, body, { timeout: 60_000 });
    return this.page.evaluate(
      ([name, step]) => {
        const hook = window.phrenic!;
        const points: [number, number, number][] = [];
        for (let i = 0; i < hook.vertices(name); i += step) points.push(hook.vertex(name, i));
        return { tick: hook.tick(), points };
      },
      [body, stride] as const,
    );
  }

  /** Waits until the connection has this state. */
  async waitForLink(kind: string): Promise<void> {
    await this.page.waitForSelector(`#connection[data-state="${kind}"]`, { timeout: 60_000 });
  }

  /** Waits for a frame with a tick above this one. */
  async waitForTick(above: number): Promise<void> {
    await this.page.waitForFunction((least) => window.phrenic!.tick() > least, above, { timeout: 30_000 });
  }

  /** Waits until the newest frame has this tick. */
  async waitForExactTick(tick: number): Promise<void> {
    await this.page.waitForFunction((wanted) => window.phrenic!.tick() === wanted, tick, { timeout: 30_000 });
  }

  /** Types a number into a parameter's entry. */
  async type(parameter: string, value: number): Promise<void> {
    const entry = this.page.locator(`#parameter-${parameter}-entry`);
    await entry.fill(String(value));
    await entry.press("Enter");
    await entry.blur();
  }

  /** Returns the text of a parameter's entry. */
  value(parameter: string): Promise<string> {
    return this.page.inputValue(`#parameter-${parameter}-entry`);
  }

  /** Saves a screenshot of the page in tests/e2e/out. */
  async saveScreenshot(name: string): Promise<void> {
    mkdirSync(outFolder, { recursive: true });
    await this.page.screenshot({ path: join(outFolder, `${name}.png`) });
  }

  /** Returns the accessibility violations that axe finds in the current page. */
  async violations(): Promise<string[]> {
    await this.page.evaluate(axe.source);
    return this.page.evaluate(async () => {
      const { violations } = await (window as unknown as { axe: typeof axe }).axe.run();
      return violations.map(({ id, nodes }) => `${id}: ${nodes.map((node) => node.target).join(", ")}`);
    });
  }

  /** Closes the browser context of the page. */
  close(): Promise<void> {
    return this.page.context().close();
  }
}
