import { expect, test } from "vitest";
import { Demand } from "../../web/src/demand";

/** Judges every 200 ms for `time` ms; how often the demand changed. */
function judge(demand: Demand, start: number, time: number, delay: number, arriving: number): number {
  let changes = 0;
  for (let now = start; now < start + time; now += 200) changes += demand.judge(now, delay, arriving) ? 1 : 0;
  return changes;
}

test("APromptLineIsAskedForEverything", () => {
  const demand = new Demand();
  expect(judge(demand, 0, 60_000, 20, 60)).toBe(0);
  expect(demand.framesPerSecond).toBe(0);
});

test("AShortHitchChangesNothing", () => {
  const demand = new Demand();
  expect(judge(demand, 0, 1200, 900, 10) + judge(demand, 1200, 1200, 20, 60)).toBe(0);
});

test("LateFramesLowerTheDemandBelowWhatArrives", () => {
  const demand = new Demand();
  judge(demand, 0, 2000, 900, 10);
  expect(demand.framesPerSecond).toBe(7);
});

test("TheDemandNeverFallsToNothing", () => {
  const demand = new Demand();
  judge(demand, 0, 60_000, 900, 0);
  expect(demand.framesPerSecond).toBe(2);
});

test("PromptFramesRaiseItAgainUpToEverything", () => {
  const demand = new Demand();
  judge(demand, 0, 2000, 900, 10);
  judge(demand, 2000, 60_000, 20, 10);
  expect(demand.framesPerSecond).toBe(0);
});
