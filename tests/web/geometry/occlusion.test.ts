import { describe, expect, test } from "vitest";
import { computeNormals } from "../../../web/src/geometry/normals";
import { computeOcclusion } from "../../../web/src/geometry/occlusion";

const across = 40;

/** A square of 1 m at height `z` with its normals up; a bowl if `bend` is given. */
function sheet(z: number, size = 1, bend: (r2: number) => number = () => 0) {
  const rest = new Float32Array(3 * across * across);
  const triangles: number[] = [];
  for (let i = 0; i < across * across; i++) {
    const [x, y] = [(i % across) / (across - 1) - 0.5, Math.floor(i / across) / (across - 1) - 0.5];
    rest.set([size * x, size * y, z + bend(x * x + y * y)], 3 * i);
    if (i % across === across - 1 || i >= across * (across - 1)) continue;
    triangles.push(i, i + 1, i + across, i + 1, i + across + 1, i + across);
  }
  const normals = new Float32Array(rest.length);
  computeNormals(rest, Uint32Array.from(triangles), normals);
  return { rest, triangles: Uint32Array.from(triangles), normals, occludes: true };
}
const middle = across * (across / 2) + across / 2;

describe("ambient occlusion", () => {
  test("OfAnOpenPlaneIsZero", () => {
    expect(Math.max(...computeOcclusion([sheet(0)])[0])).toBe(0);
  });

  test("GrowsAsACoverComesNearer", () => {
    const covered = [0.2, 0.1, 0.06].map((z) => computeOcclusion([sheet(0), sheet(z)])[0][middle]);
    expect(covered[0]).toBe(0);
    expect(covered[1]).toBeGreaterThan(0);
    expect(covered[2]).toBeGreaterThan(covered[1]);
  });

  test("OfTranslucentCoversIsZero", () => {
    const clear = { ...sheet(0.06), occludes: false };
    expect(computeOcclusion([sheet(0), clear])[0][middle]).toBe(0);
  });

  test("IsLargerAtTheBottomOfABowlThanAtItsRim", () => {
    const [bowl] = computeOcclusion([sheet(0, 1, (r2) => 5 * r2)]);
    expect(bowl[middle]).toBeGreaterThan(bowl[across / 2] + 5);
  });

  test("DoesNotDependOnTheUnit", () => {
    const [metres] = computeOcclusion([sheet(0), sheet(0.06)]);
    const [larger] = computeOcclusion([sheet(0, 1024), sheet(0.06 * 1024, 1024)]);
    expect(larger[middle]).toBe(metres[middle]);
    expect(larger[middle]).toBeGreaterThan(0);
  });

  test("OfNothingIsEmpty", () => expect(computeOcclusion([])).toEqual([]));
});
