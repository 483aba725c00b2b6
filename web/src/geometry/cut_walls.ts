import { axesOf, type AxisPlane, outlineOf } from "./section";

/** Corners of a quadrilateral as two triangles. */
export const quadIndices = [0, 1, 2, 0, 2, 3];

/**
 * Returns where a plane cuts the wall of a hollow organ: one quadrilateral for each triangle of its closed outer
 * surface that the plane crosses, from the outline inwards by the wall's thickness [m], as x y z of four corners.
 * Triangles are anticlockwise seen from outside. `shift` moves the quadrilaterals out of the plane [m].
 */
export function wallsInCut(
  positions: ArrayLike<number>,
  triangles: ArrayLike<number>,
  { axis, at }: AxisPlane,
  thickness: number,
  shift: number,
): number[] {
  const quads: number[] = [];
  for (let t = 0; t < triangles.length; t += 3) {
    const corners = [3 * triangles[t], 3 * triangles[t + 1], 3 * triangles[t + 2]];
    const above = corners.map((corner) => positions[corner + axis] >= at);
    if (above[0] === above[1] && above[1] === above[2]) continue;
    const ends = crossings(positions, corners, above, axis, at);
    const inwards = inwardsOf(positions, corners, axis);
    if (ends.length < 2 || inwards === undefined) continue;
    const [p, q] = ends;
    for (const [from, depth] of [
      [p, 0],
      [q, 0],
      [q, thickness],
      [p, thickness],
    ] as [number[], number][])
      // prettier-ignore
      for (let k = 0; k < 3; k++) quads.push(k === axis ? at + shift : from[k] + depth * inwards[k]);
  }
  return quads;
}

/**
 * Returns the inside of a closed surface where a plane cuts it, as quadrilaterals `step` high [m]: x y z of four
 * corners. They follow the outline within a step, which the wall of a hollow organ covers.
 */
export function lumenInCut(
  positions: ArrayLike<number>,
  triangles: ArrayLike<number>,
  plane: AxisPlane,
  step: number,
  shift: number,
): number[] {
  const outline = outlineOf(positions, triangles, plane, step);
  const [a, b] = axesOf(plane.axis);
  const quads: number[] = [];
  outline?.spans.forEach((row, j) => {
    const low = outline.low[1] + j * step;
    for (let i = 0; i + 1 < row.length; i += 2) {
      for (const [across, up] of [
        [row[i], 0],
        [row[i + 1], 0],
        [row[i + 1], step],
        [row[i], step],
      ]) {
        // prettier-ignore
        const corner = [0, 0, 0];
        [corner[plane.axis], corner[a], corner[b]] = [plane.at + shift, across, low + up];
        quads.push(...corner);
      }
    }
  });
  return quads;
}

/** Returns the two points of a triangle's border in the plane. */
function crossings(x: ArrayLike<number>, corners: number[], above: boolean[], axis: number, at: number): number[][] {
  const points: number[][] = [];
  for (let k = 0; k < 3; k++) {
    const next = (k + 1) % 3;
    if (above[k] === above[next]) continue;
    const [a, b] = [corners[k], corners[next]];
    const part = (at - x[a + axis]) / (x[b + axis] - x[a + axis]);
    points.push([0, 1, 2].map((j) => x[a + j] + part * (x[b + j] - x[a + j])));
  }
  return points;
}

/**
 * Returns the unit direction within the plane that points away from the triangle's outer side; undefined if it has
 * none.
 */
function inwardsOf(x: ArrayLike<number>, [a, b, c]: number[], axis: number): number[] | undefined {
  const u = [0, 1, 2].map((k) => x[b + k] - x[a + k]);
  const v = [0, 1, 2].map((k) => x[c + k] - x[a + k]);
  const inwards = [v[1] * u[2] - v[2] * u[1], v[2] * u[0] - v[0] * u[2], v[0] * u[1] - v[1] * u[0]];
  inwards[axis] = 0;
  const length = Math.hypot(...inwards);
  return length > 0 ? inwards.map((each) => each / length) : undefined;
}
