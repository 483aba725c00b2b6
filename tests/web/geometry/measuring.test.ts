import * as THREE from "three";
import { mergeVertices } from "three/addons/utils/BufferGeometryUtils.js";
import { describe, expect, test } from "vitest";
import { angleAt, distanceBetween, enclosedVolume, isClosed, surfaceArea } from "../../../web/src/geometry/measuring";

interface Mesh {
  x: Float64Array;
  triangles: Uint32Array;
}

const tetrahedron: Mesh = {
  x: Float64Array.of(0, 0, 0, 1, 0, 0, 0, 1, 0, 0, 0, 1),
  triangles: Uint32Array.of(0, 2, 1, 0, 1, 3, 1, 2, 3, 0, 3, 2),
};

/** Corners whose coordinates are the bits of their index; triangles counterclockwise seen from outside. */
function cube(edge: number, at: number[]): Mesh {
  const x = Float64Array.from({ length: 24 }, (_, i) => at[i % 3] + edge * ((Math.floor(i / 3) >> (i % 3)) & 1));
  const faces = [0, 2, 3, 1, 4, 5, 7, 6, 0, 1, 5, 4, 2, 6, 7, 3, 0, 4, 6, 2, 1, 3, 7, 5];
  const halves = [0, 4, 8, 12, 16, 20].flatMap((f) => [0, 1, 2, 0, 2, 3].map((k) => faces[f + k]));
  return { x, triangles: Uint32Array.from(halves) };
}

function sphere(detail: number, welded = true): Mesh {
  const loose = new THREE.IcosahedronGeometry(1, detail).deleteAttribute("normal").deleteAttribute("uv");
  const geometry = welded ? mergeVertices(loose) : loose;
  const x = Float64Array.from(geometry.getAttribute("position").array);
  const index = geometry.getIndex()?.array ?? Array.from({ length: x.length / 3 }, (_, i) => i);
  return { x, triangles: Uint32Array.from(index) };
}

const flipped = (triangles: Uint32Array) => triangles.slice().reverse();

describe("the area and the volume", () => {
  test("OfACubeAreExactWhereverItIs", () => {
    for (const at of [
      [0, 0, 0],
      [-1, 5, 2],
      [1e6, -1e6, 1e6],
    ]) {
      // prettier-ignore
      const { x, triangles } = cube(2, at);
      expect(surfaceArea(x, triangles)).toBe(24);
      expect(enclosedVolume(x, triangles)).toBe(8);
    }
  });

  test("OfATetrahedronAreExact", () => {
    const { x, triangles } = tetrahedron;
    expect(enclosedVolume(x, triangles)).toBeCloseTo(1 / 6, 15);
    expect(surfaceArea(x, triangles)).toBeCloseTo(1.5 + Math.sqrt(3) / 2, 15);
  });

  test("OfTheSphereAreTheLimitOfFinerSurfacesAtSecondOrder", () => {
    const errors = [3, 7, 15].map((detail) => {
      const { x, triangles } = sphere(detail);
      return [4 * Math.PI - surfaceArea(x, triangles), (4 / 3) * Math.PI - enclosedVolume(x, triangles)];
    });
    for (const k of [0, 1]) {
      // The number of edges along an arc is detail + 1.
      expect(errors[0][k] / errors[1][k]).toBeCloseTo(4, 0);
      expect(errors[1][k] / errors[2][k]).toBeCloseTo(4, 0);
      expect(errors[2][k]).toBeGreaterThan(0);
    }
  });

  test("OfTurnedTrianglesHaveTheOtherSign", () => {
    const { x, triangles } = cube(1, [0, 0, 0]);
    expect(enclosedVolume(x, flipped(triangles))).toBe(-1);
    expect(surfaceArea(x, flipped(triangles))).toBe(6);
  });

  test("OfNothingAreZero", () => {
    expect([surfaceArea([], []), enclosedVolume([], [])]).toEqual([0, 0]);
  });
});

describe("a surface is closed", () => {
  test("IfEveryEdgeIsUsedInBothDirections", () => {
    expect(isClosed(tetrahedron.x, tetrahedron.triangles)).toBe(true);
    expect(isClosed(sphere(2).x, sphere(2).triangles)).toBe(true);
  });

  test("AlsoAlongSeamsOfDoubledVertices", () =>
    expect(isClosed(sphere(2, false).x, sphere(2, false).triangles)).toBe(true));

  test("ButNotWithAHoleATurnedTriangleOrNoTriangle", () => {
    const { x, triangles } = tetrahedron;
    expect(isClosed(x, triangles.subarray(3))).toBe(false);
    expect(isClosed(x, Uint32Array.of(0, 1, 2, ...triangles.subarray(3)))).toBe(false);
    expect(isClosed(x, Uint32Array.of())).toBe(false);
  });
});

describe("the angle and the distance", () => {
  test("AreThoseOfATriangleWith3And4And5", () => {
    const [corner, a, b] = [[1, 1, 1], [4, 1, 1], [1, 5, 1]] as [number, number, number][]; // prettier-ignore
    expect(distanceBetween(a, b)).toBe(5);
    expect(angleAt(corner, a, b)).toBeCloseTo(Math.PI / 2, 15);
    expect(angleAt(a, b, corner)).toBeCloseTo(Math.atan2(4, 3), 15);
    const sum = angleAt(corner, a, b) + angleAt(a, b, corner) + angleAt(b, corner, a);
    expect(sum).toBeCloseTo(Math.PI, 14);
  });

  test("OfNearlyEqualDirectionsKeepTheirDigits", () => {
    expect(angleAt([0, 0, 0], [1, 0, 0], [1, 1e-9, 0])).toBeCloseTo(1e-9, 20);
    expect(angleAt([0, 0, 0], [1, 0, 0], [-2, 0, 0])).toBe(Math.PI);
  });

  test("AtACornerWithoutADirectionIsNoNumber", () => expect(angleAt([1, 0, 0], [1, 0, 0], [0, 0, 0])).toBeNaN());
});
