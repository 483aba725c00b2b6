import { afterEach, beforeEach, expect, test } from "vitest";
import { SampleFeed } from "../../../web/src/connection/sample_feed";
import type { Frame } from "../../../web/src/gen/phrenic/v1/frames_pb";
import { SampledQuantity_Kind } from "../../../web/src/gen/phrenic/v1/samples_pb";
import { FakeClock, settle } from "../fakes/fake_clock";
import { FakeServer } from "../fakes/fake_server";

let server: FakeServer;
let clock: FakeClock;
let numbers: Frame[];
let gaps: number;
let refusals: string[];
let feed: SampleFeed;

const quantities = [
  { kind: SampledQuantity_Kind.MEASURE, name: "lung volume", unit: "m^3" },
  { kind: SampledQuantity_Kind.PROBE, name: "sternum", unit: "m" },
];
const sample = (time: number) => ({ tick: BigInt(1000 * time), time, breath: 0.5, values: [time, -time] });
const times = () => numbers.map(({ time }) => time);

beforeEach(() => {
  [server, clock, numbers, gaps, refusals] = [new FakeServer(), new FakeClock(), [], 0, []];
  const listener = {
    sample: (each: Frame) => numbers.push(each),
    gap: () => gaps++,
    refused: (reason: string) => refusals.push(reason),
  };
  feed = new SampleFeed(server.api, "thorax", listener, clock);
});

afterEach(() => feed.stop());

test("SamplesComeOnceAndInOrderWithTheirNames", async () => {
  server.sampleBatches = [
    { quantities, present: sample(0), track: 7n, last: 0n },
    { samples: [sample(0.02), sample(0.04)], track: 7n, last: 2n },
    { samples: [sample(0.06)], track: 7n, last: 3n },
  ];
  void feed.run();
  await settle();
  expect(times()).toEqual([0, 0.02, 0.04, 0.06]);
  expect(numbers[3].measures).toMatchObject([{ name: "lung volume", value: 0.06, unit: "m^3" }]);
  expect(numbers[3].probes).toMatchObject([{ name: "sternum", dz: -0.06 }]);
  expect(server.sampleReads.map(({ track, last }) => [track, last])).toEqual([
    [0n, 0n],
    [7n, 0n],
    [7n, 2n],
  ]);
});

test("TheFeedReadsOftenWhileSamplesComeAndSeldomOtherwise", async () => {
  server.sampleBatches = [{ quantities, samples: [sample(0.02)], track: 7n, last: 1n }];
  void feed.run();
  await settle();
  await clock.advance(200);
  await clock.advance(1000);
  expect(clock.sleeps).toEqual([200, 1000, 1000]);
  feed.wake();
  await settle();
  expect(server.sampleReads.length).toBe(4);
});

test("AnErrorIsFollowedByAnotherTryFromTheSamePosition", async () => {
  server.sampleBatches = [{ quantities, samples: [sample(0.02)], track: 7n, last: 1n }];
  void feed.run();
  await settle();
  server.down = true;
  await clock.advance(200);
  server.down = false;
  server.sampleBatches = [{ samples: [sample(0.04)], leftOut: 3n, track: 7n, last: 5n }];
  await clock.advance(5000);
  expect(times()).toEqual([0.02, 0.04]);
  expect(gaps).toBe(1);
  expect(server.sampleReads.at(-1)).toMatchObject({ track: 7n, last: 1n });
});

test("CatchingUpEndsWhenTheSamplesUpToNowWereReceived", async () => {
  server.sampleBatches = [{ quantities, samples: [sample(0.02)], track: 7n, last: 1n }];
  void feed.run();
  await settle();
  server.sampleBatches = [{ samples: [sample(0.04)], track: 7n, last: 2n }];
  await feed.catchUp();
  expect(times()).toEqual([0.02, 0.04]);
  server.down = true;
  await feed.catchUp(); // a lost connection is no error here
});

test("AChangeOfTheSessionDoesNotShortenThePauseAfterAnError", async () => {
  void feed.run();
  await settle();
  server.refusal = "there are too many readers";
  await clock.advance(1000);
  const reads = server.sampleReads.length;
  for (let second = 1; second < 5; second++) {
    feed.wake();
    await clock.advance(1000);
  }
  expect(server.sampleReads.length).toBe(reads);
  await clock.advance(1000);
  expect(server.sampleReads.length).toBe(reads + 1);
});

test("ARefusalIsToldUntilARead", async () => {
  server.refusal = "there are too many readers";
  void feed.run();
  await settle();
  expect(refusals).toEqual(["there are too many readers"]);
  server.refusal = "";
  await clock.advance(5000);
  expect(refusals.at(-1)).toBe("");
});

test("SamplesOfAnotherTrackComeAfterAGap", async () => {
  server.sampleBatches = [
    { quantities, samples: [sample(0.02)], track: 7n, last: 1n },
    { samples: [sample(0.04)], track: 7n, last: 2n },
  ];
  void feed.run();
  await settle();
  expect(gaps).toBe(0);
  server.sampleBatches = [{ quantities, present: sample(100), track: 8n, last: 0n }];
  await clock.advance(200);
  expect([times().at(-1), gaps]).toEqual([100, 1]);
});
