import { create } from "@bufbuild/protobuf";
import { expect, test } from "vitest";
import { Past } from "../../../web/src/frames/frame_history";
import { FrameSchema } from "../../../web/src/gen/phrenic/v1/frames_pb";

const at = (time: number) => create(FrameSchema, { time });
function past(...times: number[]): Past {
  const result = new Past();
  for (const time of times) result.add(at(time));
  return result;
}

test("InThePresentNothingIsLookedAt", () => {
  expect(past(0, 1, 2).lookedAt).toBeUndefined();
});

test("TheFrameAtOrBeforeATimeIsLookedAt", () => {
  const frames = past(0, 1, 2);
  frames.look(1.7);
  expect(frames.lookedAt?.time).toBe(1);
  frames.look(-5);
  expect(frames.lookedAt?.time).toBe(0);
});

test("FrameByFrameItGoesBackToTheOldestAndForwardToThePresent", () => {
  const frames = past(0, 1, 2);
  const seen: (number | undefined)[] = [];
  for (const by of [-1, -1, -1, 1, 1] as const) {
    const time = frames.neighbour(by);
    frames.look(time);
    seen.push(time);
  }
  expect(seen).toEqual([1, 0, 0, 1, undefined]);
});

test("WhatIsTooLongAgoIsForgottenAndTheOldestLeftIsShown", () => {
  const frames = past(0, 1, 2);
  frames.look(1);
  frames.add(at(21.5));
  expect(frames.span).toEqual({ start: 2, end: 21.5 });
  expect(frames.lookedAt?.time).toBe(2);
});

test("ANewRunHasNoPast", () => {
  const frames = past(3, 4);
  frames.look(3);
  frames.add(at(0));
  expect(frames.span).toEqual({ start: 0, end: 0 });
  expect(frames.lookedAt).toBeUndefined();
});

test("TheNearestFrameIsOnEitherSide", () => {
  const frames = past(0, 1, 2);
  expect([-3, 0.4, 0.6, 1, 1.7, 9].map((time) => frames.nearest(time)?.time)).toEqual([0, 0, 1, 1, 2, 2]);
  expect(past().nearest(1)).toBeUndefined();
});
