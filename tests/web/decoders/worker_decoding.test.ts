import { create } from "@bufbuild/protobuf";
import { expect, test } from "vitest";
import { answerWith, type DecodingAnswer, type DecodingRequest } from "../../../web/src/decoders/decoding_messages";
import { decompress } from "../../../web/src/decoders/wasm_decoder";
import { type DecodingThread, WorkerDecoding } from "../../../web/src/decoders/worker_decoding";
import { Codec, FrameSchema } from "../../../web/src/gen/phrenic/v1/frames_pb";
import { type Body, decodeBody, type FrameArrays } from "../../../web/src/geometry/bodies";
import { decoderModule, decoderModules } from "../fakes/decoder_module";
import { bytesOf, triangleBody } from "../fakes/fake_server";
import { stored } from "../fakes/stored";

/** A worker whose answers come when the test asks for them; messages are cloned and transferred as by a browser. */
class Thread implements DecodingThread {
  onmessage: DecodingThread["onmessage"] = null;
  onerror: DecodingThread["onerror"] = null;
  readonly requests: DecodingRequest[] = [];
  private readonly answer = answerWith(() => Promise.resolve(decoderModule()));

  postMessage(message: DecodingRequest, transfer: Transferable[]): void {
    this.requests.push(structuredClone(message, { transfer: transfer as ArrayBuffer[] }));
  }

  /** Answers the oldest requests up to the first frame. */
  async work(): Promise<void> {
    for (let answer: DecodingAnswer | undefined; answer === undefined && this.requests.length > 0;) {
      answer = await this.answer(this.requests.shift()!);
      if (answer !== undefined) this.onmessage!({ data: answer } as MessageEvent<DecodingAnswer>);
    }
  }
}

const body: Body = decodeBody(triangleBody({}));

/** A frame whose vertices all have this x. */
function frameAt(x: number) {
  const positions = bytesOf(Float32Array.from({ length: 9 }, () => x));
  return create(FrameSchema, { codec: Codec.RAW, bodies: [0], positions });
}

const firstX = (result: FrameArrays | RangeError | undefined) =>
  result === undefined || result instanceof RangeError ? result : result.positions[0];

function started() {
  const thread = new Thread();
  const decoding = new WorkerDecoding(thread);
  const results: ReturnType<typeof firstX>[] = [];
  decoding.start([body]);
  const decode = (frame: ReturnType<typeof frameAt>) => decoding.decode(frame, (each) => results.push(firstX(each)));
  return { thread, decoding, results, decode };
}

test("FramesComeBackInTheirOrderAndStayWhereTheyWere", async () => {
  const { thread, results, decode } = started();
  const frames = [1, 2, 3].map(frameAt);
  frames.forEach(decode);
  for (let i = 0; i < 3; i++) await thread.work();
  expect(results).toEqual([1, 2, 3]);
  expect(frames.map(({ positions }) => positions.length)).toEqual([36, 36, 36]);
});

test("AWorkerThatLagsGetsTheNewestFrames", async () => {
  const { thread, results, decode } = started();
  for (let i = 0; i < 100; i++) decode(frameAt(i));
  expect(thread.requests.length).toBe(3); // the scene and two frames
  expect(results.length).toBe(94);
  expect(new Set(results)).toEqual(new Set([undefined]));
  for (let i = 0; i < 6; i++) await thread.work();
  expect(results.slice(94)).toEqual([0, 1, 96, 97, 98, 99]);
});

test("AFrameThatIsNotOfTheSceneIsAnErrorAndTheNextOneIsDecoded", async () => {
  const { thread, results, decode } = started();
  decode(create(FrameSchema, { codec: Codec.PREDICTED, bodies: [0], positions: new Uint8Array(3) }));
  decode(frameAt(7));
  await thread.work();
  await thread.work();
  expect(results).toEqual([new RangeError("predicted: the head is cut off."), 7]);
});

test("FramesOfTheSceneBeforeAreNotReported", async () => {
  const { thread, decoding, results, decode } = started();
  decode(frameAt(1));
  decoding.start([body]);
  decode(frameAt(2));
  await thread.work();
  await thread.work();
  expect(results).toEqual([2]);
});

test("AWorkerThatCannotRunFailsEveryFrame", () => {
  const { thread, results, decode } = started();
  for (let i = 0; i < 3; i++) decode(frameAt(i));
  thread.onerror!({ message: "" } as ErrorEvent);
  decode(frameAt(4));
  expect(results).toEqual(Array(4).fill(new RangeError("decoder: its worker cannot be started.")));
});

test.each([...decoderModules])("TheModuleNeedsNothingOfThePage (%s)", (_, module) => {
  expect(WebAssembly.Module.imports(module)).toEqual([]);
});

test("WhatNeedsTooMuchMemoryIsAnError", () => {
  const frame = stored(new Uint8Array(5));
  expect([...decompress(decoderModule(), frame)]).toEqual([0, 0, 0, 0, 0]);
  const huge = Uint8Array.from([0x28, 0xb5, 0x2f, 0xfd, 0xa0, 0xff, 0xff, 0xff, 0x7f, 1, 0, 0]);
  expect(() => decompress(decoderModule(), huge)).toThrow(RangeError);
});

test("ADecoderThatCouldNotBeLoadedIsLoadedForTheNextFrame", async () => {
  let loads = 0;
  const answer = answerWith(() =>
    loads++ === 0 ? Promise.reject(new Error("HTTP 503")) : Promise.resolve(decoderModule()),
  );
  await answer({ bodies: [body] });
  expect(await answer({ number: 1, frame: frameAt(5) })).toMatchObject({ number: 1, positions: { 0: 5 } });
  await answer({ number: 2, frame: frameAt(5) });
  expect(loads).toBe(2);
});

test("ABasisThatCameBeforeTheDecoderIsNotLost", async () => {
  const reasons = [new Error("HTTP 503"), new Error("HTTP 503")];
  const answer = answerWith(() => {
    const reason = reasons.pop();
    return reason === undefined ? Promise.resolve(decoderModule()) : Promise.reject(reason);
  });
  await answer({ bodies: [body] });
  await answer({ basis: { epoch: 4n, shapes: [] } });
  const frame = create(FrameSchema, { codec: Codec.BASIS, bodies: [0], basisEpoch: 4n });
  expect(await answer({ number: 1, frame })).not.toMatchObject({
    problem: expect.stringContaining("has not been received") as unknown,
  });
});
