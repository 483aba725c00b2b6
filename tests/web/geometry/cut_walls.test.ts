import { expect, test } from "vitest";
import { lumenInCut, wallsInCut } from "../../../web/src/geometry/cut_walls";

const [radius, thickness, around] = [0.01, 0.002, 60];

/** An upright tube without ends, its triangles anticlockwise seen from outside. */
function tube(): { positions: number[]; triangles: number[] } {
  const positions: number[] = [];
  const triangles: number[] = [];
  for (const z of [0, 0.1])
    for (let i = 0; i < around; i++) {
      const turn = (2 * Math.PI * i) / around;
      positions.push(radius * Math.cos(turn), radius * Math.sin(turn), z);
    }
  for (let i = 0; i < around; i++) {
    const next = (i + 1) % around;
    triangles.push(i, next, around + next, i, around + next, around + i);
  }
  return { positions, triangles };
}

function area(quads: number[]): number {
  let sum = 0;
  for (let q = 0; q < quads.length; q += 12) {
    const [ux, uy] = [quads[q + 6] - quads[q], quads[q + 7] - quads[q + 1]];
    const [vx, vy] = [quads[q + 9] - quads[q + 3], quads[q + 10] - quads[q + 4]];
    sum += Math.abs(ux * vy - uy * vx) / 2;
  }
  return sum;
}

test("TheWallOfATubeIsARingInsideOfItsSurface", () => {
  const { positions, triangles } = tube();
  const quads = wallsInCut(positions, triangles, { axis: 2, at: 0.03 }, thickness, 1e-4);
  expect(quads.length / 12).toBe(2 * around);
  for (let i = 0; i < quads.length; i += 3) {
    const distance = Math.hypot(quads[i], quads[i + 1]);
    expect(distance).toBeLessThan(radius + 1e-9);
    expect(distance).toBeGreaterThan(radius - thickness - 3e-5);
    expect(quads[i + 2]).toBeCloseTo(0.0301, 9);
  }
  // The quadrilaterals overlap where the outline is convex, by thickness / (2 radius).
  const outline = 2 * around * radius * Math.sin(Math.PI / around);
  expect(area(quads)).toBeCloseTo(outline * thickness, 9);
});

test("APlaneBesideATubeCutsNoWall", () => {
  const { positions, triangles } = tube();
  expect(wallsInCut(positions, triangles, { axis: 2, at: 0.2 }, thickness, 0)).toEqual([]);
});

test("ASurfaceTurnedInsideOutHasItsWallOutside", () => {
  const { positions, triangles } = tube();
  const quads = wallsInCut(positions, triangles.reverse(), { axis: 2, at: 0.03 }, thickness, 0);
  const distances = Array.from({ length: quads.length / 3 }, (_, i) => Math.hypot(quads[3 * i], quads[3 * i + 1]));
  expect(Math.max(...distances)).toBeGreaterThan(radius + 0.9 * thickness);
});

test("TheLumenFillsTheOutline", () => {
  const { positions, triangles } = tube();
  const quads = lumenInCut(positions, triangles, { axis: 2, at: 0.03 }, 5e-4, 1e-4);
  expect(area(quads)).toBeCloseTo((around / 2) * radius ** 2 * Math.sin((2 * Math.PI) / around), 6);
  for (let i = 0; i < quads.length; i += 3) expect(quads[i + 2]).toBeCloseTo(0.0301, 9);
  expect(lumenInCut(positions, triangles, { axis: 2, at: 0.2 }, 5e-4, 0)).toEqual([]);
});
