import { expect, test } from "vitest";
import { Backoff } from "../../../web/src/timing/backoff";

test("DelaysDoubleUpToTheMaximum", () => {
  const backoff = new Backoff(500, 3000, () => 0);
  expect([1, 2, 3, 4, 5].map(() => backoff.next())).toEqual([500, 1000, 2000, 3000, 3000]);
});

test("JitterReducesDelaysByAtMostHalf", () => {
  expect(new Backoff(500, 3000, () => 0.999999).next()).toBeCloseTo(250, 2);
});

test("ResetStartsOver", () => {
  const backoff = new Backoff(500, 3000, () => 0);
  backoff.next();
  backoff.reset();
  expect(backoff.next()).toBe(500);
});
