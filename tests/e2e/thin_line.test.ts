import { connect, createServer } from "node:net";
import { setTimeout as sleep } from "node:timers/promises";
import { afterAll, beforeAll, expect, test } from "vitest";
import { SessionConnection } from "../../web/src/connection/session_connection";
import { ImmediateDecoding } from "../../web/src/decoders/decoding";
import { FrameBuffer } from "../../web/src/frames/frame_buffer";
import { systemClock } from "../../web/src/timing/clock";
import { decoderModule } from "../web/fakes/decoder_module";
import { nodeApi } from "./node_api";
import { Server } from "./server";

let server: Server;
beforeAll(async () => void (server = await Server.start()));
afterAll(() => server.end());

/** Creates a proxy that limits the bandwidth from the server to the viewer; the other direction is not limited. */
async function slowLine(url: string, bytesPerSecond: number): Promise<{ url: string; close: () => void }> {
  const { port } = new URL(url);
  let free = 0; // time at which the line is free again [ms]
  const line = createServer((viewer) => {
    const upstream = connect(Number(port), "127.0.0.1");
    viewer.pipe(upstream);
    viewer.on("error", () => upstream.destroy());
    viewer.on("close", () => upstream.destroy());
    void (async () => {
      for await (const chunk of upstream) {
        free = Math.max(free, Date.now()) + (1000 * (chunk as Buffer).length) / bytesPerSecond;
        await sleep(Math.max(0, free - Date.now()));
        viewer.write(chunk as Buffer);
      }
      viewer.end();
    })().catch(() => viewer.destroy());
  });
  await new Promise<void>((done) => line.listen(0, "127.0.0.1", done));
  const address = line.address();
  if (typeof address !== "object" || address === null) throw new Error("The line has no port.");
  return { url: `http://127.0.0.1:${address.port}`, close: () => line.close() };
}

// Watches the session for `seconds` with the viewer's connection but without drawing.
async function watch(url: string, seconds: number) {
  const api = nodeApi(url);
  const frames = new FrameBuffer(new ImmediateDecoding(decoderModule()), () => {});
  const ages: number[] = [];
  let last = 0;
  const connection = new SessionConnection(
    api,
    "thorax",
    {
      state: () => {},
      session: () => {},
      scene: (bodies) => frames.start(bodies),
      frame: (frame) => {
        frames.receive(frame, Date.now());
        expect(frames.arrays?.positions.every(Number.isFinite)).toBe(true);
        // Server and test run on one machine and share its clock.
        ages.push(Date.now() - Number(frame.unixNanos / 1_000_000n));
        last = Date.now();
      },
      basis: (basis) => frames.addBasis(basis),
      acknowledged: (response, sent, answered) => frames.acknowledged(response, sent, answered),
    },
    systemClock,
  );
  const running = connection.run();
  for (const deadline = Date.now() + 90_000; ages.length === 0 && Date.now() < deadline;) await sleep(50);
  // The same frame rate at a tenth of the simulation speed, so that the test measures the line and not the CPU.
  await api.sessions.playSession({ sessionId: "thorax", speed: 0.1 });
  await sleep(2000);
  ages.length = 0;
  await sleep(1000 * seconds);
  const rate = frames.rate(last);
  connection.stop();
  await running;
  ages.sort((a, b) => a - b);
  return { rate, frames: ages.length / seconds, median: ages[Math.floor(ages.length / 2)] };
}

test("OverFourMegabitsFramesAreLessThan400MillisecondsOld", async () => {
  const line = await slowLine(server.url, 500_000);
  const seen = await watch(line.url, 8);
  line.close();
  expect(seen.median).toBeLessThan(400);
  expect(seen.frames).toBeGreaterThan(10);
  expect(seen.rate.age).toBeLessThan(600);
});
