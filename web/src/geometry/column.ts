import type { Surface } from "./surface";

/** Returns the index of the highest vertex on one side of the body, -1 for the patient's right (x < 0); -1 if none. */
export function summitOf(positions: Float32Array, side: number): number {
  let summit = -1;
  for (let i = 0; 3 * i < positions.length; i++) {
    if (side * positions[3 * i] <= 0) continue;
    if (summit < 0 || positions[3 * i + 2] > positions[3 * summit + 2]) summit = i;
  }
  return summit;
}

/** Crossings that are closer are one: a line through an edge crosses both of its triangles [m]. */
const distinct = 1e-5;

/** Returns the heights at which a surface crosses the vertical line through (x, y) [m], ascending. */
export function crossings({ positions, triangles }: Surface, x: number, y: number): number[] {
  const heights: number[] = [];
  for (let i = 0; i < triangles.length; i += 3) {
    const [a, b, c] = [3 * triangles[i], 3 * triangles[i + 1], 3 * triangles[i + 2]];
    const [ax, bx, cx] = [positions[a] - x, positions[b] - x, positions[c] - x];
    if ((ax > 0 && bx > 0 && cx > 0) || (ax < 0 && bx < 0 && cx < 0)) continue;
    const [ay, by, cy] = [positions[a + 1] - y, positions[b + 1] - y, positions[c + 1] - y];
    // Twice the areas of the triangles that the line has with each side: equal signs inside.
    const [u, v, w] = [bx * cy - cx * by, cx * ay - ax * cy, ax * by - bx * ay];
    const area = u + v + w;
    if (area === 0 || u * area < 0 || v * area < 0 || w * area < 0) continue;
    heights.push((u * positions[a + 2] + v * positions[b + 2] + w * positions[c + 2]) / area);
  }
  heights.sort((first, second) => first - second);
  return heights.filter((height, i) => i === 0 || height - heights[i - 1] > distinct);
}
