import { setTimeout as sleep } from "node:timers/promises";
import { afterAll, beforeAll, expect, test } from "vitest";
import { SessionConnection } from "../../web/src/connection/session_connection";
import { FrameDecoder } from "../../web/src/decoders/frame_decoder";
import { Codec, type Frame } from "../../web/src/gen/phrenic/v1/frames_pb";
import { type Body, type FrameArrays } from "../../web/src/geometry/bodies";
import { systemClock } from "../../web/src/timing/clock";
import { decoderModule } from "../web/fakes/decoder_module";
import { nodeApi } from "./node_api";
import { Server } from "./server";

let server: Server;
beforeAll(async () => void (server = await Server.start()));
afterAll(() => server?.end());

const names = { [Codec.PLANES]: "planes", [Codec.PREDICTED]: "predicted", [Codec.BASIS]: "basis" };
type Coded = keyof typeof names;

/** Returns the largest distance of a vertex from its exact position [mm]. */
function worst({ positions: a }: FrameArrays, { positions: b }: FrameArrays): number {
  let largest = 0;
  for (let i = 0; i < a.length; i += 3) {
    largest = Math.max(largest, Math.hypot(a[i] - b[i], a[i + 1] - b[i + 1], a[i + 2] - b[i + 2]));
  }
  return 1000 * largest;
}

/** Watches the thorax with one codec until `until` returns true. */
async function follow(codec: Codec, until: (frame: Frame, decoder: FrameDecoder) => boolean): Promise<void> {
  const api = nodeApi(server.url);
  let decoder = new FrameDecoder(decoderModule(), []);
  let done = false;
  const listener = {
    state: () => {},
    session: () => {},
    acknowledged: () => {},
    scene: (bodies: Body[]) => void (decoder = new FrameDecoder(decoderModule(), bodies)),
    basis: (basis: Parameters<FrameDecoder["addBasis"]>[0]) => decoder.addBasis(basis),
    frame: (frame: Frame) => void (done ||= until(frame, decoder)),
  };
  const connection = new SessionConnection(api, "thorax", listener, systemClock);
  connection.setCodec(codec);
  const running = connection.run();
  for (const deadline = Date.now() + 60_000; !done && Date.now() < deadline;) await sleep(20);
  connection.stop();
  await running;
  expect(done, "the frames did not come within a minute").toBe(true);
}

/** Returns the CPU time to decode one frame of this codec [ms], after warm-up. */
async function decodingTime(codec: Coded): Promise<number> {
  const frames: Frame[] = [];
  let decoder = new FrameDecoder(decoderModule(), []);
  await follow(codec, (frame, used) => {
    decoder = used;
    if (frame.codec === codec) frames.push(frame);
    return frames.length === 30;
  });
  const pass = () => frames.forEach((frame) => decoder.decode(frame));
  for (let i = 0; i < 5; i++) pass();
  const passes = 10;
  const { user: start } = process.cpuUsage();
  for (let i = 0; i < passes; i++) pass();
  return (process.cpuUsage().user - start) / 1000 / passes / frames.length;
}

// Node.js has the same JavaScript engine as Chromium. CPU time is measured because the machine may be shared; the limit
// is the interval of 60 frames per second.
test.each([Codec.PLANES, Codec.PREDICTED, Codec.BASIS] as Coded[])(
  "AFrameIsDecodedWithinItsInterval (%d)",
  async (codec) => {
    const time = await decodingTime(codec);
    console.log(`decoding a frame of thorax, ${names[codec]}: ${time.toFixed(2)} ms of CPU`);
    expect(time).toBeLessThan(1000 / 60);
  },
);

test("DecodedFramesAreWithinTheirErrorBound", async () => {
  const api = nodeApi(server.url);
  // The server has computed the basis by now. The session is paused so that all codecs encode the same frame.
  await api.sessions.pauseSession({ sessionId: "thorax" });
  const at = async (codec: Codec) => {
    let seen: { frame: Frame; arrays: FrameArrays } | undefined;
    await follow(codec, (frame, decoder) => {
      seen = { frame, arrays: decoder.decode(frame) };
      return true;
    });
    return seen!;
  };
  const raw = await at(Codec.RAW);
  for (const codec of [Codec.PLANES, Codec.PREDICTED]) {
    const { frame, arrays } = await at(codec);
    expect(frame.tick).toBe(raw.frame.tick);
    expect(frame.codec).toBe(codec);
    expect(worst(arrays, raw.arrays)).toBeLessThanOrEqual(frame.maxErrorMm);
    expect(worst(arrays, raw.arrays)).toBeGreaterThan(0);
  }
});
