import { create } from "@bufbuild/protobuf";
import { expect, test } from "vitest";
import { LiveDistance } from "../../../web/src/appearance/live_distance";
import { SurfaceDistanceSchema } from "../../../web/src/gen/phrenic/v1/compare_pb";
import { Placement } from "../../../web/src/gen/phrenic/v1/frames_pb";
import { decodeBody } from "../../../web/src/geometry/bodies";
import { type Surface } from "../../../web/src/geometry/surface";
import type { Comparison } from "../../../web/src/session/comparisons";
import { NearestSurface } from "../../../web/src/viewer/nearest_surface";
import { triangleBody } from "../fakes/fake_server";

/** A square of two triangles from 0 to 1 m in x and y, at height `z` [m]. */
const square = (z: number): Surface => ({
  positions: Float32Array.from([0, 0, z, 1, 0, z, 1, 1, z, 0, 1, z]),
  triangles: Uint32Array.from([0, 1, 2, 0, 2, 3]),
});

test("DistancesAreToTrianglesNotVertices", () => {
  const points = Float32Array.from([0.5, 0.5, 0.003, 0.2, 0.7, -0.25, 4, 5, 0, -1, 0.5, 0]);
  const distances = new NearestSurface(square(0)).distances(points);
  [3, 250, 5000, 1000].forEach((mm, i) => expect(distances[i]).toBeCloseTo(mm, 3));
});

test("TheOrderOfPointsDoesNotMatter", () => {
  let seed = 1;
  const random = () => (seed = (seed * 16807) % 2147483647) / 2147483647;
  const points = Float32Array.from({ length: 300 }, () => 4 * random() - 2);
  const [x, y, z] = [0, 1, 2].map((axis) => (i: number) => points[3 * i + axis]);
  const beyond = (value: number) => Math.max(0, -value, value - 1);
  new NearestSurface(square(0))
    .distances(points)
    .forEach((mm, i) => expect(mm).toBeCloseTo(1000 * Math.hypot(beyond(x(i)), beyond(y(i)), z(i)), 2));
});

const body = decodeBody(triangleBody({ placement: Placement.STREAMED }));
const comparison: Comparison = {
  file: "b.obj",
  body: "triangle",
  time: 0,
  tick: 0n,
  distance: create(SurfaceDistanceSchema),
  warnings: [],
  distances: [0, 0, NaN],
  surface: square(0),
};
const raised = (z: number) => ({
  positions: body.rest.map((x, i) => (i % 3 === 2 ? z : x)),
  poses: new Float32Array(),
});

test("DistancesFollowTheFrameAndAreNaNWithoutATriangle", () => {
  const live = new LiveDistance(comparison);
  expect([...Array.from(live.values)]).toEqual([0, 0, NaN]);
  expect(live.update([body], raised(0.25), () => 0)).toBe(true);
  expect([...Array.from(live.values)]).toEqual([250, 250, NaN]);
});

test("ASlowMachineComputesLessOften", () => {
  const live = new LiveDistance(comparison);
  let now = 0;
  // Each call of the clock returns 10 ms more.
  expect(live.update([body], raised(0.1), () => (now += 10))).toBe(true);
  expect(live.update([body], raised(0.2), () => now)).toBe(false);
  expect(live.update([body], raised(0.2), () => now + 1000)).toBe(true);
});

test("WithoutASurfaceTheMeasuredDistancesStay", () => {
  const live = new LiveDistance({ ...comparison, surface: undefined });
  expect(live.update([body], raised(0.25), () => 0)).toBe(false);
  expect(live.values).toBe(comparison.distances);
});
