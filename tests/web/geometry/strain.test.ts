import { expect, test } from "vitest";
import { principalStrains } from "../../../web/src/geometry/strain";

/** Two triangles that share an edge, in the plane z = 0. */
const rest = new Float32Array([0, 0, 0, 2, 0, 0, 0.5, 1.5, 0, 2, 2, 0]);
const triangles = new Uint32Array([0, 1, 2, 1, 3, 2]);

function moved(move: (x: number, y: number, z: number) => number[]): Float32Array {
  const now = new Float32Array(rest.length);
  for (let i = 0; i < rest.length; i += 3) now.set(move(rest[i], rest[i + 1], rest[i + 2]), i);
  return now;
}

const both = (now: Float32Array) =>
  (["largest", "smallest"] as const).map((which) => [...principalStrains(rest, now, triangles, which)]);

function expectAll(now: Float32Array, largest: number, smallest: number): void {
  const [large, small] = both(now);
  for (const value of large) expect(value).toBeCloseTo(largest, 3);
  for (const value of small) expect(value).toBeCloseTo(smallest, 3);
}

test("RigidMotionHasNoStrain", () => {
  const [c, s] = [Math.cos(0.7), Math.sin(0.7)];
  expectAll(
    moved((x, y, z) => [c * x - s * z + 4, y - 1, s * x + c * z]),
    0,
    0,
  );
});

test("AxialStretchesArePrincipalStrains", () => {
  expectAll(
    moved((x, y, z) => [1.3 * x, 0.9 * y, z]),
    30,
    -10,
  );
});

test("PrincipalStrainsAreInvariantUnderRotation", () => {
  const [c, s] = [Math.cos(0.4), Math.sin(0.4)];
  expectAll(
    moved((x, y) => [1.2 * x, c * 1.1 * y, s * 1.1 * y]),
    20,
    10,
  );
});

test("SimpleShearHasItsPrincipalStretches", () => {
  // The principal stretches of a simple shear g are g/2 + sqrt(1 + g^2/4) and its inverse.
  const stretch = 0.25 + Math.sqrt(1 + 0.0625);
  expectAll(
    moved((x, y, z) => [x + 0.5 * y, y, z]),
    100 * (stretch - 1),
    100 * (1 / stretch - 1),
  );
});

test("AVertexWithoutATriangleIsNaN", () => {
  const lonely = new Float32Array([...rest, 9, 9, 9]);
  expect(principalStrains(lonely, lonely, triangles, "largest")[4]).toBeNaN();
});
