import { describe, expect, test } from "vitest";
import { AdaptiveResolution } from "../../../web/src/viewer/adaptive_resolution";

describe("the adaptive resolution", () => {
  /** Records frames every `interval` ms for `time` ms. */
  const run = (resolution: AdaptiveResolution, start: number, interval: number, time: number, drawing = true) => {
    for (let now = start; now < start + time; now += interval) resolution.recordFrame(now, drawing);
    return start + time;
  };

  test("IsFullOnAFastMachine", () => {
    const sharpness = new AdaptiveResolution(2);
    run(sharpness, 0, 16, 10_000);
    expect(sharpness.ratio).toBe(2);
  });

  test("IsReducedDuringMotionOnASlowMachine", () => {
    const resolution = new AdaptiveResolution(2);
    const now = run(resolution, 0, 200, 10_000);
    expect(resolution.ratio).toBeLessThan(1);
    run(resolution, now, 16, 1000, false);
    expect(resolution.ratio).toBe(2);
  });

  test("IsNotReducedBelowTheLeast", () => {
    const resolution = new AdaptiveResolution(2, 1, 0.8);
    run(resolution, 0, 500, 60_000);
    expect(resolution.ratio).toBe(0.8);
  });

  test("MayBeHigherAtRestThanItEverIsInMotion", () => {
    const resolution = new AdaptiveResolution(2, 1);
    const now = run(resolution, 0, 16, 5000);
    expect(resolution.ratio).toBe(1);
    run(resolution, now, 16, 1000, false);
    expect(resolution.ratio).toBe(2);
  });
});
