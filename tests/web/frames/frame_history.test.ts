import { create } from "@bufbuild/protobuf";
import { expect, test } from "vitest";
import { FrameHistory } from "../../../web/src/frames/frame_history";
import { FrameSchema } from "../../../web/src/gen/phrenic/v1/frames_pb";

const at = (time: number) => create(FrameSchema, { time });
function historyOf(...times: number[]): FrameHistory {
  const result = new FrameHistory();
  for (const time of times) result.add(at(time));
  return result;
}

test("LiveThereIsNoReplayedFrame", () => {
  expect(historyOf(0, 1, 2).replayed).toBeUndefined();
});

test("TheLastFrameUpToATimeIsReplayed", () => {
  const frames = historyOf(0, 1, 2);
  frames.replayAt(1.7);
  expect(frames.replayed?.time).toBe(1);
  frames.replayAt(-5);
  expect(frames.replayed?.time).toBe(0);
});

test("SteppingGoesBackToTheOldestAndForwardToLive", () => {
  const frames = historyOf(0, 1, 2);
  const seen: (number | undefined)[] = [];
  for (const by of [-1, -1, -1, 1, 1] as const) {
    const time = frames.adjacentTime(by);
    frames.replayAt(time);
    seen.push(time);
  }
  expect(seen).toEqual([1, 0, 0, 1, undefined]);
});

test("OldFramesAreDroppedAndTheOldestLeftIsReplayed", () => {
  const frames = historyOf(0, 1, 2);
  frames.replayAt(1);
  frames.add(at(21.5));
  expect(frames.span).toEqual({ start: 2, end: 21.5 });
  expect(frames.replayed?.time).toBe(2);
});

test("AResetClearsTheHistory", () => {
  const frames = historyOf(3, 4);
  frames.replayAt(3);
  frames.add(at(0));
  expect(frames.span).toEqual({ start: 0, end: 0 });
  expect(frames.replayed).toBeUndefined();
});

test("NearestFindsEarlierAndLaterFrames", () => {
  const frames = historyOf(0, 1, 2);
  expect([-3, 0.4, 0.6, 1, 1.7, 9].map((time) => frames.nearest(time)?.time)).toEqual([0, 0, 1, 1, 2, 2]);
  expect(historyOf().nearest(1)).toBeUndefined();
});
