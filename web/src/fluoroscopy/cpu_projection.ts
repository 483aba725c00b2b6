import { type Absorber, posed } from "./absorbers";
import type { Projection } from "./c_arm";

/**
 * Vertices in the frame of the rays: x y in the picture, in pixels from its upper left corner, and z = depth + source
 * distance [m].
 */
type Screen = Float64Array;

/**
 * Returns the line integrals of the attenuation coefficient along the rays through the middles of pixels, row by row
 * from the upper left: as the graphics card computes them, on the processor. Each front face adds weight times its
 * distance along the ray, each back face subtracts it. The rule for pixels on an edge makes closed surfaces closed in
 * the picture too.
 */
export function projectOnProcessor(absorbers: Absorber[], at: Projection, size: number): Float32Array<ArrayBuffer> {
  const sums = new Float64Array(size * size);
  for (const absorber of absorbers) {
    const screen = screenOf(posed(absorber.vertices, absorber.pose), at, size);
    const { triangles, weight } = absorber;
    for (let t = 0; t < triangles.length; t += 3) {
      addTriangle(sums, screen, [3 * triangles[t], 3 * triangles[t + 1], 3 * triangles[t + 2]], weight, at, size);
    }
  }
  return Float32Array.from(sums);
}

function screenOf(vertices: Float32Array, at: Projection, size: number): Screen {
  const screen = new Float64Array(vertices.length);
  const { right, up, toDetector, isocentre, sourceDistance, halfWidth } = at;
  for (let i = 0; i < vertices.length; i += 3) {
    const [x, y, z] = [vertices[i] - isocentre[0], vertices[i + 1] - isocentre[1], vertices[i + 2] - isocentre[2]];
    const depth = toDetector[0] * x + toDetector[1] * y + toDetector[2] * z + sourceDistance;
    const scale = size / 2 / halfWidth / (sourceDistance === 0 ? 1 : depth / sourceDistance);
    screen[i] = size / 2 + scale * (right[0] * x + right[1] * y + right[2] * z);
    screen[i + 1] = size / 2 - scale * (up[0] * x + up[1] * y + up[2] * z);
    screen[i + 2] = depth;
  }
  return screen;
}

function addTriangle(
  sums: Float64Array,
  s: Screen,
  [a, b, c]: number[],
  weight: number,
  at: Projection,
  size: number,
): void {
  // Rows go down: a front face is clockwise here.
  const area = side(s, a, b, s[c], s[c + 1]);
  if (area === 0) return;
  const facing = area < 0 ? 1 : -1;
  const [left, right] = pixels(s[a], s[b], s[c], size);
  const [top, bottom] = pixels(s[a + 1], s[b + 1], s[c + 1], size);
  for (let row = top; row <= bottom; row++) {
    for (let column = left; column <= right; column++) {
      const [x, y] = [column + 0.5, row + 0.5];
      const [u, v, w] = [-facing * side(s, b, c, x, y), -facing * side(s, c, a, x, y), -facing * side(s, a, b, x, y)];
      if (!within(u, s, b, c, facing) || !within(v, s, c, a, facing) || !within(w, s, a, b, facing)) continue;
      sums[row * size + column] += facing * weight * distance(s, [a, b, c], [u, v, w], [x, y], at, size);
    }
  }
}

/** The first and last pixel whose middle may lie in the triangle, along one axis. */
function pixels(a: number, b: number, c: number, size: number): [number, number] {
  return [Math.max(0, Math.ceil(Math.min(a, b, c) - 0.5)), Math.min(size - 1, Math.floor(Math.max(a, b, c) - 0.5))];
}

/** On which side of the edge a point lies: exactly opposite for the opposite edge, since the ends have an order. */
function side(s: Screen, from: number, to: number, x: number, y: number): number {
  const swap = s[from] > s[to] || (s[from] === s[to] && s[from + 1] > s[to + 1]);
  const [a, b] = swap ? [to, from] : [from, to];
  const value = (s[b] - s[a]) * (y - s[a + 1]) - (s[b + 1] - s[a + 1]) * (x - s[a]);
  return swap ? -value : value;
}

/** True if a point is inside of an edge; of two triangles beside an edge, one has the points on it. */
function within(value: number, s: Screen, from: number, to: number, facing: number): boolean {
  if (value !== 0) return value > 0;
  const [dx, dy] = [facing * (s[to] - s[from]), facing * (s[to + 1] - s[from + 1])];
  return dy < 0 || (dy === 0 && dx > 0);
}

/** Distance along the ray, from the source, or from the isocentre's plane for parallel rays [m]. */
function distance(
  s: Screen,
  corners: number[],
  parts: number[],
  [x, y]: number[],
  at: Projection,
  size: number,
): number {
  const sum = parts[0] + parts[1] + parts[2];
  const { sourceDistance, halfWidth } = at;
  let [depth, inverse] = [0, 0];
  corners.forEach((corner, i) => {
    depth += (parts[i] / sum) * s[corner + 2];
    inverse += parts[i] / sum / s[corner + 2];
  });
  if (sourceDistance === 0) return depth;
  const scale = (2 * halfWidth) / size / sourceDistance;
  return Math.hypot((x - size / 2) * scale, (y - size / 2) * scale, 1) / inverse;
}
