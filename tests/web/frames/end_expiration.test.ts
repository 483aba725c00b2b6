import { expect, test } from "vitest";
import { EndExpirationDetector } from "../../../web/src/frames/end_expiration";

test("ExpirationEndsAtTheMinimumOfTheSignal", () => {
  const detector = new EndExpirationDetector();
  const breath = [0, 0.5, 1, 0.5, 0, -0.2, -0.2, 0.1, 0.5, 0.2, 0.3];
  expect(breath.map((value) => detector.receive(value)).flatMap((turned, i) => (turned ? [i] : []))).toEqual([7, 10]);
});
