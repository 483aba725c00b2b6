import { expect, test } from "vitest";
import { maxHold, PlayoutBuffer } from "../../../web/src/frames/playout";

/** Offset of the server's clock [ms]. */
const ahead = 49_000;

interface Arrival {
  made: number;
  arrived: number;
}

/** Frames at intervals of `gap` [ms], each delayed by `late` [ms]. The content of a frame is its creation time. */
function arrivals(count: number, gap: number, late: (i: number) => number): Arrival[] {
  return Array.from({ length: count }, (_, i) => ({ made: ahead + i * gap, arrived: i * gap + late(i) }));
}

/** Plays the frames at display intervals of `beat` [ms] and returns what is displayed at each time. */
function play(frames: Arrival[], beat = 1000 / 60) {
  const playout = new PlayoutBuffer<number>();
  const seen: { now: number; moment: number; newest: number; delay: number }[] = [];
  let next = 0;
  for (let now = 0; now < frames[frames.length - 1].arrived + 500; now += beat) {
    for (; next < frames.length && frames[next].arrived <= now; next++)
      playout.receive(frames[next].made, frames[next].made, frames[next].arrived);
    const between = playout.at(now);
    if (between === undefined) continue;
    const moment = between.before + between.part * (between.after - between.before);
    seen.push({ now, moment, newest: frames[next - 1].made, delay: playout.delay });
  }
  return seen;
}

const uneven = (i: number) => 12 + ((i * 7) % 11);
const cases: [string, Arrival[]][] = [
  ["even", arrivals(90, 33, () => 10)],
  ["uneven", arrivals(90, 33, uneven)],
  ["stalled once", arrivals(90, 33, (i) => (i >= 40 && i < 44 ? 130 - 33 * (i - 40) + 10 : 10))],
  ["twice the screen's rate", arrivals(200, 8, uneven)],
];

test.each(cases)("TimeIsMonotonicAndNeverAheadOfReceivedFrames: %s", (_, frames) => {
  const seen = play(frames);
  seen.forEach(({ moment, newest }, i) => {
    expect(moment).toBeLessThanOrEqual(newest);
    if (i > 0) expect(moment).toBeGreaterThanOrEqual(seen[i - 1].moment);
  });
});

test.each(cases)("TheDelayIsBounded: %s", (_, frames) => {
  for (const { delay } of play(frames)) expect(delay).toBeLessThanOrEqual(maxHold + 100);
});

test("RegularFramesAreDisplayedEvenlyOneFrameLate", () => {
  const seen = play(arrivals(90, 33, () => 10)).filter(({ now }) => now > 500 && now < 2500);
  for (let i = 1; i < seen.length; i++) expect(seen[i].moment - seen[i - 1].moment).toBeCloseTo(1000 / 60, 6);
  for (const { delay } of seen) expect(delay).toBeCloseTo(33, 6);
});

test("ReceivedFramesAreDisplayedExactly", () => {
  const playout = new PlayoutBuffer<string>();
  playout.receive("a", ahead, 0);
  playout.receive("b", ahead + 30, 30);
  expect(playout.at(30)).toEqual({ before: "a", after: "b", part: 0 });
  expect(playout.at(45)!.part).toBeCloseTo(0.5, 9);
  expect(playout.at(60)).toEqual({ before: "b", after: "b", part: 0 });
});

test("WithoutNewFramesTheNewestStays", () => {
  const seen = play(arrivals(30, 33, uneven));
  const last = ahead + 29 * 33;
  expect(seen.at(-1)!.moment).toBe(last);
  expect(seen.filter(({ moment }) => moment === last).length).toBeGreaterThan(10);
});

test("AfterALongGapTheNextFrameIsDisplayedImmediately", () => {
  const playout = new PlayoutBuffer<string>();
  playout.receive("a", ahead, 0);
  playout.receive("b", ahead + 30, 30);
  playout.at(30);
  playout.receive("step", ahead + 5000, 5000);
  expect(playout.at(5000)).toEqual({ before: "step", after: "step", part: 0 });
  expect(playout.delay).toBe(0);
});
