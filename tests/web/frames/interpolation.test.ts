import { expect, test } from "vitest";
import { interpolate } from "../../../web/src/frames/interpolation";

const frame = (places: number[], pose: number[]) => ({
  positions: new Float32Array(places),
  poses: new Float32Array(pose),
});
/** A rotation about z by this angle [degrees]. */
const turned = (degrees: number, sign = 1) => {
  const half = (degrees * Math.PI) / 360;
  return [0, 0, sign * Math.sin(half), sign * Math.cos(half), degrees, 0, 0];
};

const a = frame([0, 1, 2], turned(10));
const b = frame([4, 1, -2], turned(14));

test("EndsReturnTheFramesThemselves", () => {
  expect(interpolate(a, b, 0)).toBe(a);
  expect(interpolate(a, b, 1)).toBe(b);
  expect(interpolate(a, a, 0.3)).toBe(a);
});

test("PositionsAreInterpolatedLinearly", () => {
  expect([...interpolate(a, b, 0.25).positions]).toEqual([1, 1, 1]);
});

test.each([1, -1])("OrientationsTakeTheShorterArc, with quaternion sign %d", (sign) => {
  const { poses } = interpolate(a, frame([4, 1, -2], turned(14, sign)), 0.5);
  turned(12).forEach((value, k) => expect(poses[k]).toBeCloseTo(value, 6));
  expect(Math.hypot(poses[0], poses[1], poses[2], poses[3])).toBeCloseTo(1, 6);
});
