// Clients that are not part of this project: buf curl, which reads the schema by server reflection, and @grpc/grpc-js,
// which reads the .proto files. The viewer's own client, @connectrpc/connect-web in Chromium, is tested in
// viewer.test.ts.
import {
  type ClientReadableStream,
  credentials,
  loadPackageDefinition,
  type ServiceError,
  status,
} from "@grpc/grpc-js";
import { loadSync } from "@grpc/proto-loader";
import { execFile } from "node:child_process";
import { join } from "node:path";
import { promisify } from "node:util";
import { afterAll, beforeAll, expect, test } from "vitest";
import { Server } from "./server";

const proto = join(import.meta.dirname, "../../proto");
const buf = join(import.meta.dirname, "node_modules/.bin/buf");

let server: Server;
beforeAll(async () => void (server = await Server.start("cube-springs")));
afterAll(() => server?.end());

type Answer = Record<string, any>;
type Call = (request: object, answered: (error: ServiceError | null, answer: Answer) => void) => void;

/** Creates a client of one service with grpc-js from the .proto files. */
function serviceOf(file: string, name: string): Record<string, any> {
  const options = { includeDirs: [proto], longs: Number, enums: String, defaults: true };
  const definition = loadPackageDefinition(loadSync(`phrenic/v1/${file}.proto`, options)) as any;
  return new definition.phrenic.v1[name](server.address, credentials.createInsecure());
}

const call = (service: Record<string, any>, method: string, request: object) =>
  promisify((service[method] as Call).bind(service))(request) as Promise<Answer>;

async function curl(url: string, method: string, request: object, ...flags: string[]): Promise<Answer[]> {
  const words = ["curl", ...flags, "--data", JSON.stringify(request), `${url}/phrenic.v1.${method}`];
  const { stdout } = await promisify(execFile)(buf, words, { maxBuffer: 1 << 26 });
  // A stream prints one JSON object after the other.
  return JSON.parse(`[${stdout.replaceAll(/^\}\s*\{/gm, "},{")}]`);
}

const overGrpc = () => [`http://${server.address}`, "--protocol", "grpc", "--http2-prior-knowledge"] as const;
const overWeb = () => [server.url.replace(/\/$/, ""), "--protocol", "grpcweb", "--schema", proto] as const;

test("BufCurlCallsByReflection", async () => {
  const [url, ...flags] = overGrpc();
  const [{ sessions }] = await curl(url, "SessionService/ListSessions", {}, ...flags);
  expect(sessions.map(({ id }: Answer) => id)).toEqual(["cube-springs"]);
  const set = { sessionId: "cube-springs", parameters: { breathForce: 1.5 } };
  await curl(url, "SessionService/UpdateParameters", set, ...flags);
  const [{ session }] = await curl(url, "SessionService/GetSession", { sessionId: "cube-springs" }, ...flags);
  expect(session.parameters.breathForce).toBe(1.5);
});

test("BufCurlReceivesErrorMessages", async () => {
  const [url, ...flags] = overGrpc();
  const asked = curl(url, "SessionService/GetSession", { sessionId: "nobody" }, ...flags);
  await expect(asked).rejects.toMatchObject({ stderr: expect.stringContaining("there is no session") });
});

test("BufCurlReadsAStreamOverTheGateway", async () => {
  const [url, ...flags] = overWeb();
  const bodies = await curl(url, "FrameService/GetGeometry", { sessionId: "cube-springs" }, ...flags);
  expect(bodies).toHaveLength(bodies[0].bodyCount);
  expect(Buffer.from(bodies[0].restPositions, "base64")).toHaveLength(8 * 12);
  const [{ session }] = await curl(url, "SessionService/GetSession", { sessionId: "cube-springs" }, ...flags);
  expect(session.id).toBe("cube-springs");
});

test("GrpcJsCreatesStepsWatchesAndAcknowledges", async () => {
  const sessions = serviceOf("session", "SessionService");
  const frames = serviceOf("frames", "FrameService");
  await call(sessions, "createSession", { sessionId: "node", source: { name: "cube-tensegrity" } });
  const names = { sessionId: "node", watchId: "grpc-js" };
  const stream: ClientReadableStream<Answer> = frames.watchFrames({ ...names, maxUnackedFrames: 1 });
  stream.on("error", () => {});
  const frame = (async () => {
    for await (const { frame } of stream) {
      if (frame == null) continue;
      const answer = await call(frames, "ackFrames", { ...names, sequence: frame.sequence });
      expect(answer.maxUnackedFrames).toBe(1);
      if (frame.tick === 20) return frame as Answer;
    }
    throw new Error("The stream ended before the frame came.");
  })();
  const { stateHash } = await call(sessions, "stepSession", { sessionId: "node", ticks: 20 });
  expect(stateHash).toMatch(/^[0-9a-f]+$/);
  const { positions, codec } = await frame;
  expect(codec).toBe("CODEC_RAW");
  expect(positions).toHaveLength(8 * 12);
  stream.cancel();
  await expect(call(sessions, "getSession", { sessionId: "nobody" })).rejects.toMatchObject({
    code: status.NOT_FOUND,
  });
});
