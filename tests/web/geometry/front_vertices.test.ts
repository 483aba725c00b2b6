import { expect, test } from "vitest";
import { frontVertices, type ScreenSurface } from "../../../web/src/geometry/front_vertices";

/** A rectangle of two triangles from (left, top) to (right, bottom) at a depth. */
function sheet(left: number, top: number, right: number, bottom: number, depth: number, opaque = true): ScreenSurface {
  const places = Float32Array.of(left, top, depth, right, top, depth, left, bottom, depth, right, bottom, depth);
  return { places, triangles: [0, 1, 2, 1, 3, 2], opaque };
}

/** Counts the pixels of each surface on 10 x 10 pixels. */
function counts(...surfaces: ScreenSurface[]): number[] {
  const found = frontVertices(surfaces, 10, 10);
  return surfaces.map((_, i) => found.filter(({ surface }) => surface === i).length);
}

test("ASurfaceHasThePixelsWhoseCentresItCoversOnceEach", () => {
  expect(counts(sheet(2, 3, 7, 6, 0))).toEqual([15]);
  const keys = frontVertices([sheet(2, 3, 7, 6, 0)], 10, 10).map(({ x, y }) => `${x} ${y}`);
  expect(new Set(keys).size).toBe(15);
});

test("TheFrontSurfaceHidesTheOneBehindWhateverTheirOrder", () => {
  const [front, back] = [sheet(0, 0, 5, 10, 0.2), sheet(0, 0, 10, 10, 0.4)];
  expect(counts(front, back)).toEqual([50, 50]);
  expect(counts(back, front)).toEqual([50, 50]);
});

test("ATransparentSurfaceHidesNothingAndIsHidden", () => {
  expect(counts(sheet(0, 0, 5, 10, 0.2, false), sheet(0, 0, 10, 10, 0.4))).toEqual([50, 100]);
  expect(counts(sheet(0, 0, 5, 10, 0.6, false), sheet(0, 0, 10, 10, 0.4))).toEqual([0, 100]);
});

test("APixelHasTheNearestCorner", () => {
  const at = (x: number, y: number) =>
    frontVertices([sheet(0, 0, 10, 10, 0)], 10, 10).find((each) => each.x === x && each.y === y)?.vertex;
  expect([at(1, 0), at(8, 1), at(1, 8), at(8, 9)]).toEqual([0, 1, 2, 3]);
});

test("VerticesThatAreNotShownAndPixelsOutsideAreLeftOut", () => {
  const clipped = sheet(0, 0, 10, 10, 0);
  clipped.places[0] = NaN; // of the first triangle only
  expect(counts(clipped)[0]).toBeGreaterThan(40);
  expect(counts(clipped)[0]).toBeLessThan(60);
  expect(counts(sheet(-20, -20, 30, 30, 0))).toEqual([100]);
  expect(counts(sheet(20, 20, 30, 30, 0))).toEqual([0]);
});

test("ABodyWithoutTrianglesShowsItsVertices", () => {
  expect(counts({ ...sheet(1, 1, 5, 5, 0), triangles: [] })).toEqual([4]);
});
