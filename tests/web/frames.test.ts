import { create } from "@bufbuild/protobuf";
import { expect, test } from "vitest";
import { Frames } from "../../web/src/frames";
import { AckFramesResponseSchema, FrameSchema } from "../../web/src/gen/phrenic/v1/frames_pb";

const nanos = (milliseconds: number) => BigInt(milliseconds) * 1_000_000n;
const answer = (milliseconds: number) => create(AckFramesResponseSchema, { unixNanos: nanos(milliseconds) });

test("AgeIsTakenByTheServersClockFromTheQuickestAnswer", () => {
  const frames = new Frames();
  expect(frames.rate(0).age).toBeUndefined();
  frames.receive(create(FrameSchema, { unixNanos: nanos(50_000), maxErrorMm: 0.2 }), 1040);
  expect(frames.rate(1040).age).toBeUndefined();
  // The server's clock is 49 s ahead: 51,000 there is 2000 here, and the slow answer that says otherwise does not count.
  frames.acknowledged(answer(51_000), 1995, 2005);
  frames.acknowledged(answer(53_000), 2000, 2900);
  expect(frames.rate(1040)).toEqual({ framesPerSecond: 1, age: 40, errorBound: 0.2 });
});

test("FramesOlderThanASecondDoNotCount", () => {
  const frames = new Frames();
  for (const now of [0, 500, 1200]) frames.receive(create(FrameSchema, {}), now);
  expect(frames.rate(1300).framesPerSecond).toBe(2);
});
