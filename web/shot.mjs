import { chromium } from "playwright-core";
import { spawn } from "node:child_process";
const bin = process.env.BIN ?? "/tmp/pre";
const scene = process.env.SCENE ?? "thorax";
const [w, h] = (process.env.SIZE ?? "1200x720").split("x").map(Number);
const port = 18000 + Math.floor(Math.random() * 900);
const server = spawn(`${bin}/phrenicd`, ["--listen", `127.0.0.1:${port}`, "--web", `127.0.0.1:${port + 1000}`, "--start", scene], { stdio: "inherit" });
const browser = await chromium.launch({ executablePath: "/usr/bin/chromium", headless: true, args: ["--no-sandbox", "--use-gl=angle", "--use-angle=swiftshader", "--enable-unsafe-swiftshader"] });
try {
  const context = await browser.newContext({ viewport: { width: w, height: h } });
  const page = await context.newPage();
  page.on("console", (m) => console.log(m.type(), m.text()));
  page.on("pageerror", (e) => console.log("pageerror", e.stack));
  for (let i = 0; i < 100; i++) { try { await fetch(`http://127.0.0.1:${port + 1000}/`); break; } catch { await new Promise((r) => setTimeout(r, 200)); } }
  const t0 = Date.now();
  await page.goto(`http://127.0.0.1:${port + 1000}/`);
  const drawn = () => (window.phrenic?.tick() ?? -1) >= 0 && (window.phrenic?.pictures() ?? 0) > 1;
  await page.waitForFunction(drawn, null, { timeout: 60000 }).catch((e) => console.log("no picture", e.message));
  console.log("picture after", Date.now() - t0, await page.evaluate(() => [window.phrenic?.tick(), window.phrenic?.pictures()]), await page.textContent("#link"));
  const leave = (name) => page.screenshot({ path: `/tmp/shot-${name}.png`, timeout: 60000 });
  const { default: steps } = await import(process.argv[2]);
  await steps({ page, leave, server, drawn, browser });
} catch (e) { console.log(e); } finally { await browser.close(); server.kill("SIGKILL"); }
