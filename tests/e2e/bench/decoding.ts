import { readdirSync } from "node:fs";
import { join } from "node:path";
import { setTimeout as sleep } from "node:timers/promises";
import { afterAll, beforeAll, expect, test } from "vitest";
import { SessionConnection } from "../../../web/src/connection/session_connection";
import { type EncodedBasis, type EncodedFrame, FrameDecoder } from "../../../web/src/decoders/frame_decoder";
import { Codec, type Frame, Placement } from "../../../web/src/gen/phrenic/v1/frames_pb";
import type { Body } from "../../../web/src/geometry/bodies";
import { systemClock } from "../../../web/src/timing/clock";
import { decoderModules } from "../../web/fakes/decoder_module";
import { launchBrowser } from "../browser";
import { nodeApi } from "../node_api";
import { Server } from "../server";

// Measures decoders on frames of a breathing thorax (npm run bench): back to back and 60 times a second, in Node.js and
// in Chromium. PHRENIC_OLD names another checkout, with its viewer's packages and messages, whose decoders are measured
// too.
const codecs = { planes: Codec.PLANES, predicted: Codec.PREDICTED, basis: Codec.BASIS };
const frameCount = 120;
/** Bodies are watched up to this number of vertices; 0 for all. */
const mostVertices = Number(process.env.PHRENIC_VERTICES ?? 20_000);

interface Recording {
  bodies: Body[];
  bases: EncodedBasis[];
  frames: Frame[];
}
interface Timed {
  addBasis(basis: EncodedBasis): void;
  decode(frame: EncodedFrame): { positions: Float32Array };
}

let server: Server;
beforeAll(async () => void (server = await Server.start()));
afterAll(() => server?.end());

/** Returns the first streamed bodies that have `mostVertices` vertices together, without those that exceed it. */
function chosen(bodies: Body[]): Body[] {
  let sum = 0;
  return bodies.filter(({ placement, rest }) => {
    if (placement !== Placement.STREAMED || (mostVertices > 0 && sum + rest.length / 3 > mostVertices)) return false;
    sum += rest.length / 3;
    return true;
  });
}

/** Returns frames of the thorax by one codec, and what decodes them. */
async function record(codec: Codec): Promise<Recording> {
  const recording: Recording = { bodies: [], bases: [], frames: [] };
  const listener = {
    state: () => {},
    session: () => {},
    acknowledged: () => {},
    scene: (bodies: Body[]) => {
      recording.bodies = bodies;
      connection.setBodies(chosen(bodies).map(({ name }) => name));
    },
    basis: (basis: EncodedBasis) => void recording.bases.push(basis),
    frame: (frame: Frame) => {
      if (frame.codec === codec && frame.bodies.length === chosen(recording.bodies).length)
        recording.frames.push(frame);
    },
  };
  const connection = new SessionConnection(nodeApi(server.url), "thorax", listener, systemClock);
  connection.setCodec(codec);
  const running = connection.run();
  for (const end = Date.now() + 90_000; recording.frames.length < frameCount && Date.now() < end;) await sleep(20);
  connection.stop();
  await running;
  expect(recording.frames.length).toBeGreaterThanOrEqual(frameCount);
  return recording;
}

/** Returns median and 95th percentile of the times of `work` [ms], called `interval` ms apart. */
async function times(work: (i: number) => void, interval: number): Promise<string> {
  const all: number[] = [];
  for (let i = 0; i < 2 * frameCount; i++) {
    if (interval > 0) await sleep(interval);
    const start = performance.now();
    work(i % frameCount);
    all.push(performance.now() - start);
  }
  const sorted = all.slice(frameCount).sort((a, b) => a - b); // without the warm-up
  return [0.5, 0.95].map((part) => sorted[Math.floor(part * sorted.length)].toFixed(2)).join("; ");
}

async function decoders({ bodies, bases }: Recording): Promise<[string, Timed][]> {
  const made: [string, Timed][] = [...decoderModules].map(([build, module]) => [
    build,
    new FrameDecoder(module, bodies),
  ]);
  if (process.env.PHRENIC_OLD !== undefined) {
    const old = await import(/* @vite-ignore */ join(process.env.PHRENIC_OLD, "web/src/decoders/frame_decoder.ts"));
    made.push(["old", new old.FrameDecoder(bodies)]);
  }
  for (const [, decoder] of made) for (const basis of bases) decoder.addBasis(basis);
  return made;
}

test.each(Object.entries(codecs))("DecodingIn Node.js: %s", async (name, codec) => {
  const recording = await record(codec);
  const { frames } = recording;
  const bytes = frames.reduce((sum, { positions }) => sum + positions.length, 0) / frames.length;
  let reference: Float32Array | undefined;
  for (const [build, decoder] of await decoders(recording)) {
    const start = performance.now();
    const { positions } = decoder.decode(frames[0]);
    const setup = performance.now() - start;
    expect(positions).toEqual((reference ??= positions)); // bit for bit
    const decode = (i: number) => void decoder.decode(frames[i]);
    const vertices = frames[0].bodies.reduce((sum, index) => sum + recording.bodies[index].rest.length / 3, 0);
    const line = `setup ${setup.toFixed(0)}, back to back ${await times(decode, 0)}, at 60 Hz ${await times(decode, 1000 / 60)}`;
    console.log(`${name}, ${vertices} vertices, ${bytes.toFixed(0)} bytes, ${build}: ${line} [ms: p50; p95]`);
  }
});

/** Runs in the page: decodes with the module that the viewer loads, through its C interface, 60 times a second. */
async function inPage(of: { url: string; rest: number[]; edges: number[]; frames: string[]; codec: number }) {
  const { instance } = await WebAssembly.instantiate(await (await fetch(of.url)).arrayBuffer());
  const wasm = instance.exports as Record<string, (...numbers: number[]) => number> & { memory: WebAssembly.Memory };
  const copyIn = (bytes: Uint8Array) => {
    const at = wasm.phrenic_allocate(bytes.length);
    new Uint8Array(wasm.memory.buffer, at, bytes.length).set(bytes);
    return at;
  };
  const rest = copyIn(new Uint8Array(Float32Array.from(of.rest).buffer));
  const edges = copyIn(new Uint8Array(Uint32Array.from(of.edges).buffer));
  const decoder = wasm.phrenic_decoder_make(rest, of.rest.length / 3, edges, of.edges.length / 2);
  const frames = of.frames.map((text) => Uint8Array.from(atob(text), (letter) => letter.charCodeAt(0)));
  const room = wasm.phrenic_allocate(Math.max(...frames.map(({ length }) => length)));
  const all: number[] = [];
  for (let i = 0; i < 4 * frames.length; i++) {
    await new Promise((done) => setTimeout(done, 1000 / 60));
    const start = performance.now();
    const bytes = frames[i % frames.length];
    new Uint8Array(wasm.memory.buffer, room, bytes.length).set(bytes);
    if (wasm.phrenic_decoder_decode(decoder, of.codec, room, bytes.length, rest) !== 0) throw new Error("refused");
    new Uint8Array(wasm.memory.buffer, rest, 4 * of.rest.length).slice();
    all.push(performance.now() - start);
  }
  const sorted = all.slice(frames.length).sort((a, b) => a - b);
  return [0.5, 0.95].map((part) => sorted[Math.floor(part * sorted.length)]);
}

test("DecodingInChromium", async () => {
  const { bodies, frames } = await record(Codec.PREDICTED);
  const streamed = frames[0].bodies.map((index) => bodies[index]);
  const rest = streamed.flatMap((body) => [...body.rest]);
  let first = 0;
  const edges = streamed.flatMap((body) => {
    const before = first;
    first += body.rest.length / 3;
    const own = [...body.triangles].flatMap((a, i, all) => [a, all[i % 3 === 2 ? i - 2 : i + 1]]);
    return (body.edges.length > 0 ? [...body.edges] : own).map((vertex) => before + vertex);
  });
  const encoded = frames.map(({ positions }) => Buffer.from(positions).toString("base64"));
  const assets = join(import.meta.dirname, "../../../web/dist/assets");
  const browser = await launchBrowser();
  const page = await browser.newPage();
  await page.goto(`${server.url}?session=none`);
  for (const build of ["simd", "plain"]) {
    const url = `/assets/${readdirSync(assets).find((name) => name.startsWith(build) && name.endsWith(".wasm"))}`;
    const result = await page.evaluate(inPage, { url, rest, edges, frames: encoded, codec: Codec.PREDICTED });
    console.log(
      `predicted, ${rest.length / 3} vertices, Chromium, ${build}: at 60 Hz ${result.map((time) => time.toFixed(2)).join("; ")} [ms: p50; p95]`,
    );
  }
  await browser.close();
});
