import { type ChildProcess, execFile, spawn } from "node:child_process";
import { createWriteStream, existsSync, mkdirSync, mkdtempSync, rmSync } from "node:fs";
import { createServer } from "node:net";
import { tmpdir } from "node:os";
import { join, resolve } from "node:path";
import { setTimeout as sleep } from "node:timers/promises";
import { promisify } from "node:util";

const here = import.meta.dirname;
/** Folder for screenshots, logs and files of the tests. */
export const outFolder = join(here, "out");

/** A phrenicd process on free ports; its log is in tests/e2e/out. */
export class Server {
  private process: ChildProcess | undefined;
  private readonly store = mkdtempSync(join(tmpdir(), "phrenic-e2e-"));

  private constructor(
    private readonly listen: number,
    private readonly web: number,
    private readonly scene: string,
    private readonly flags: string[],
  ) {}

  /**
   * Starts a server with a playing session of `scene`; "none" for no session. `flags` may depend on the address of the
   * page.
   */
  static async start(scene = "thorax", flags: string[] | ((url: string) => string[]) = []): Promise<Server> {
    const [listen, web] = [await freePort(), await freePort()];
    const words = typeof flags === "function" ? flags(`http://127.0.0.1:${web}`) : flags;
    const server = new Server(listen, web, scene, words);
    await server.restart();
    return server;
  }

  /** The id of the process. */
  get pid(): number {
    return this.process!.pid!;
  }

  /** The address of the page. */
  get url(): string {
    return `http://127.0.0.1:${this.web}/`;
  }

  /** The gRPC address. */
  get address(): string {
    return `127.0.0.1:${this.listen}`;
  }

  /**
   * Starts the process again on the same ports. Resolves when it serves the page and has its first session; throws
   * Error after a minute.
   */
  async restart(): Promise<void> {
    mkdirSync(outFolder, { recursive: true });
    const log = createWriteStream(join(outFolder, "phrenicd.log"), { flags: "a" });
    const addresses = ["--listen", `127.0.0.1:${this.listen}`, "--web", `127.0.0.1:${this.web}`];
    const flags = [...addresses, "--start", this.scene, "--store", this.store, ...this.flags];
    const child = spawn(program("phrenicd"), flags, { stdio: ["ignore", "pipe", "pipe"] });
    child.stdout.pipe(log, { end: false });
    child.stderr.pipe(log, { end: false });
    this.process = child;
    let started = false; // it prints its addresses once the first session is made
    child.stdout.on("data", (text) => (started ||= String(text).includes("Viewer: ")));
    for (const deadline = Date.now() + 60_000; Date.now() < deadline; await sleep(100)) {
      if (child.exitCode !== null)
        throw new Error(`phrenicd ended with ${child.exitCode}: see ${outFolder}/phrenicd.log.`);
      if (started && (await answers(this.url))) return;
    }
    throw new Error(`phrenicd did not serve ${this.url} within a minute: see ${outFolder}/phrenicd.log.`);
  }

  /** Returns the session "thorax" as the command line prints it in JSON. */
  async session() {
    const { sessions } = JSON.parse(await this.phrenic("sessions", "-o", "json"));
    return sessions.find(({ id }: { id: string }) => id === "thorax");
  }

  /** Adds an account to an account file and returns its token. */
  static async addAccount(file: string, name: string, role: string): Promise<string> {
    const words = ["token", "add", "--tokens", file, "--name", name, "--role", role];
    return (await promisify(execFile)(program("phrenicd"), words)).stdout.trim();
  }

  /** Runs the command line against this server and returns its output. */
  async phrenic(...words: string[]): Promise<string> {
    const flags = ["--server", `127.0.0.1:${this.listen}`, ...words];
    // Keeps the command line's tokens in the tests' folder.
    const env = { ...process.env, XDG_STATE_HOME: join(outFolder, "state") };
    return (await promisify(execFile)(program("phrenic"), flags, { env })).stdout;
  }

  /** Waits until the session is paused and returns its tick. */
  async restingTick(): Promise<number> {
    for (const deadline = Date.now() + 30_000; Date.now() < deadline; await sleep(100)) {
      const { state, tick } = await this.session();
      if (state === "SESSION_STATE_PAUSED") return Number(tick);
    }
    throw new Error("The session did not come to rest within 30 s.");
  }

  /** Kills the process like a crash. */
  async kill(): Promise<void> {
    const child = this.process;
    if (child === undefined || child.exitCode !== null || child.signalCode !== null) return;
    const ended = new Promise((done) => child.once("exit", done));
    child.kill("SIGKILL");
    await ended;
  }

  /** Kills the process and deletes its store. */
  async end(): Promise<void> {
    await this.kill();
    rmSync(this.store, { recursive: true, force: true });
  }
}

function program(name: string): string {
  const path = resolve(process.env.PHRENIC_BINARY_DIR ?? join(here, "../../build"), name);
  if (existsSync(path)) return path;
  throw new Error(`There is no ${path}: build it, or set PHRENIC_BINARY_DIR to the folder that has it.`);
}

async function answers(url: string): Promise<boolean> {
  try {
    return (await fetch(url)).ok;
  } catch {
    return false;
  }
}

function freePort(): Promise<number> {
  return new Promise((done, fail) => {
    const server = createServer();
    server.once("error", fail);
    server.listen(0, "127.0.0.1", () => {
      const address = server.address();
      server.close(() => (typeof address === "object" && address !== null ? done(address.port) : fail(address)));
    });
  });
}
