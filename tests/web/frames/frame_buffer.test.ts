import { create } from "@bufbuild/protobuf";
import { expect, test } from "vitest";
import { FrameBuffer } from "../../../web/src/frames/frame_buffer";
import { AckFramesResponseSchema, Codec, FrameSchema } from "../../../web/src/gen/phrenic/v1/frames_pb";
import { decodeBody } from "../../../web/src/geometry/bodies";

import { ImmediateDecoding } from "../../../web/src/decoders/decoding";
import { decoderModule } from "../fakes/decoder_module";
import { triangleBody } from "../fakes/fake_server";

const newBuffer = () =>
  new FrameBuffer(new ImmediateDecoding(decoderModule()), (error) => {
    throw error;
  });

const nanos = (milliseconds: number) => BigInt(milliseconds) * 1_000_000n;
const answer = (milliseconds: number) => create(AckFramesResponseSchema, { unixNanos: nanos(milliseconds) });

test("AgeUsesTheClockOffsetOfTheShortestRoundTrip", () => {
  const frames = newBuffer();
  expect(frames.rate(0).age).toBeUndefined();
  frames.receive(create(FrameSchema, { unixNanos: nanos(50_000), maxErrorMm: 0.2 }), 1040);
  expect(frames.rate(1040).age).toBeUndefined();
  // The server's clock is 49 s ahead: 51,000 ms there is 2,000 ms here. The slow answer with another offset is ignored.
  frames.acknowledged(answer(51_000), 1995, 2005);
  frames.acknowledged(answer(53_000), 2000, 2900);
  expect(frames.rate(1040)).toEqual({ framesPerSecond: 1, age: 40, delay: 0, errorBound: 0.2 });
});

test("FramesOlderThanASecondDoNotCount", () => {
  const frames = newBuffer();
  for (const now of [0, 500, 1200]) frames.receive(create(FrameSchema, {}), now);
  expect(frames.rate(1300).framesPerSecond).toBe(2);
});

/** A frame with one vertex at x = time, created at this time of the server [ms]. */
function frameAt(made: number, time: number) {
  const positions = new Uint8Array(new Float32Array([time, 0, 0]).buffer);
  return create(FrameSchema, { unixNanos: nanos(made), time, positions, codec: Codec.RAW, bodies: [0] });
}

function watched(): FrameBuffer {
  const frames = newBuffer();
  const point = triangleBody({ restPositions: new Uint8Array(12), triangles: new Uint8Array() });
  frames.start([decodeBody(point)]);
  frames.receive(frameAt(50_000, 1), 1000);
  frames.receive(frameAt(50_040, 2), 1040);
  return frames;
}

test("TheDisplayInterpolatesBetweenTwoFrames", () => {
  const frames = watched();
  frames.advance(1040, false);
  expect(frames.advance(1060, false)).toBe(true);
  expect(frames.displayed!.time).toBeCloseTo(1.5, 9);
  expect(frames.displayed!.arrays.positions[0]).toBeCloseTo(1.5, 6);
  expect(frames.arrays!.positions[0]).toBe(2);
  expect(frames.rate(1060).delay).toBe(40);
  // No more frames arrive: the display ends at the newest frame and is not drawn again.
  frames.advance(1100, false);
  expect(frames.displayed!.arrays).toBe(frames.arrays);
  expect(frames.advance(1200, false)).toBe(false);
});

test("ReducedMotionDisplaysTheNewestFrame", () => {
  const frames = watched();
  frames.advance(1050, true);
  expect(frames.displayed!.arrays).toBe(frames.arrays);
  expect(frames.rate(1050).delay).toBe(0);
});

test("ASlowMachineDoesNotInterpolate", () => {
  const frames = watched();
  for (let i = 1; i < 40; i++) {
    frames.receive(frameAt(50_040 + 100 * i, 2 + i), 1040 + 100 * i);
    frames.advance(1045 + 100 * i, false);
  }
  expect(frames.displayed!.arrays).toBe(frames.arrays);
});

test("AResetIsDisplayedImmediately", () => {
  const frames = watched();
  frames.advance(1040, false);
  frames.receive(frameAt(50_080, 0), 1080);
  frames.advance(1080, false);
  expect(frames.displayed!.time).toBe(0);
});

/** Two synchronised buffers: the first has frames up to 1.4 s, the second up to 1.1 s, all received before 1400 ms. */
function pair(): [FrameBuffer, FrameBuffer] {
  const [ahead, behind] = [watched(), watched()];
  ahead.synchroniseWith(behind);
  for (const time of [1, 1.1, 1.2, 1.3, 1.4]) ahead.receive(frameAt(50_000 + 1000 * time, time), 1000 * time);
  for (const time of [1, 1.1]) behind.receive(frameAt(50_000 + 1000 * time, time), 1000 * time);
  return [ahead, behind];
}

test("SynchronisedBuffersDisplayTheSameTime", () => {
  const [ahead, behind] = pair();
  expect(ahead.liveFrame(1400)?.time).toBeCloseTo(1.1, 9);
  expect(behind.liveFrame(1400)?.time).toBeCloseTo(1.1, 9);
  expect(ahead.frame?.time).toBeCloseTo(1.4, 9);
  ahead.advance(1400, true);
  expect(ahead.displayed?.time).toBeCloseTo(1.1, 9);
  expect(ahead.displayed?.arrays.positions[0]).toBeCloseTo(1.1, 6);
  behind.receive(frameAt(51_420, 1.3), 1420);
  ahead.advance(1420, true);
  expect(ahead.displayed?.time).toBeCloseTo(1.3, 9);
});

test("APartnerWithoutFramesIsNotWaitedFor", () => {
  const [ahead, behind] = pair();
  ahead.receive(frameAt(52_000, 1.5), 3200);
  expect(ahead.liveFrame(3200)?.time).toBeCloseTo(1.5, 9);
  // The display does not go back when frames arrive again.
  ahead.advance(3200, true);
  behind.receive(frameAt(52_200, 1.2), 3201);
  ahead.advance(3201, true);
  expect(ahead.displayed?.time).toBeCloseTo(1.5, 9);
});

test("APartnerFarBehindIsNotWaitedFor", () => {
  const [ahead] = pair();
  ahead.receive(frameAt(51_500, 3.2), 1500);
  expect(ahead.liveFrame(1500)?.time).toBeCloseTo(3.2, 9);
});

/** Decodes when the test says so, as a worker does. */
class LateDecoding extends ImmediateDecoding {
  private late: (() => void)[] = [];

  override decode(...of: Parameters<ImmediateDecoding["decode"]>): void {
    this.late.push(() => super.decode(...of));
  }

  work(): void {
    this.late.splice(0).forEach((each) => each());
  }
}

/** A buffer that has received frames at 1000, 1040 ... ms; the one at x is of the time x. */
function lateBuffer(count: number) {
  const decoding = new LateDecoding(decoderModule());
  const errors: string[] = [];
  const frames = new FrameBuffer(decoding, ({ message }) => errors.push(message));
  frames.start([decodeBody(triangleBody({ restPositions: new Uint8Array(12), triangles: new Uint8Array() }))]);
  for (let i = 0; i < count; i++) frames.receive(frameAt(50_000 + 40 * i, 1 + i), 1000 + 40 * i);
  return { decoding, frames, errors };
}

test("WhatIsStillBeingDecodedIsDisplayedLater", () => {
  const { decoding, frames } = lateBuffer(1);
  expect(frames.advance(1000, false)).toBe(false);
  expect(frames.displayed).toBeUndefined();
  decoding.work();
  expect(frames.advance(1010, false)).toBe(true);
  frames.receive(frameAt(50_040, 2), 1040);
  frames.advance(1090, false); // due is 2 or before; only 1 is decoded
  expect(frames.displayed!.time).toBe(1);
  decoding.work();
  frames.advance(1100, false);
  expect(frames.displayed!.time).toBe(2);
});

test("AReplayThatMovesWithEveryDrawingIsShown", () => {
  const { decoding, frames } = lateBuffer(10);
  decoding.work();
  const shown = [2, 3, 4, 5, 6].map((time, i) => {
    frames.replayAt(time);
    frames.advance(1400 + 16 * i, false);
    decoding.work(); // too late for this drawing
    return frames.displayed?.time;
  });
  expect(shown.slice(1)).toEqual([2, 3, 4, 5]);
});

test("AFrameThatCannotBeDecodedIsReportedAndTheOneBeforeStays", () => {
  const { decoding, frames, errors } = lateBuffer(2);
  decoding.work();
  frames.advance(1050, true);
  frames.receive(create(FrameSchema, { unixNanos: nanos(50_080), time: 3, bodies: [0] }), 1080);
  decoding.work();
  frames.advance(1090, true);
  expect(errors).toEqual(["positions: the bytes are of another number of vertices."]);
  expect(frames.displayed!.time).toBe(2);
});
