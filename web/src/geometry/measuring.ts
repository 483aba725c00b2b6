/** x y z [m]. */
type Point = readonly [number, number, number];

/**
 * The measurements that links and lessons keep, and the points that each needs; "body" is the surface of a whole body.
 */
export const pointsOfKept = { distance: 2, angle: 3, surface: 1, body: 1 } as const;

/** A measurement of vertices, each named by its body and its place at rest [m], so that it is found on another mesh. */
export interface KeptMeasurement {
  tool: keyof typeof pointsOfKept;
  points: { body: string; rest: Point }[];
}

/** Most measurements of a scene. */
export const mostMeasurements = 12;

/** Returns what is wrong with a measurement of a file or an address, after its field; undefined if nothing is. */
export function faultOfMeasurement(
  tool: string,
  points: { rest?: { [k in "x" | "y" | "z"]: number } }[],
): string | undefined {
  const known = Object.keys(pointsOfKept);
  if (!known.includes(tool)) return `tool: "${tool}" is not one of ${known.join(", ")}`;
  const needed = pointsOfKept[tool as KeptMeasurement["tool"]];
  if (points.length !== needed) return `points: "${tool}" needs ${needed}, not ${points.length}`;
  const wrong = points.findIndex(({ rest }) => ![rest?.x, rest?.y, rest?.z].every(Number.isFinite));
  return wrong < 0 ? undefined : `points[${wrong}].rest: give the three numbers of a place`;
}

/** Returns the vertex nearest to a place; -1 without vertices. `rest`: x y z per vertex [m]. */
export function nearestVertex(rest: ArrayLike<number>, [x, y, z]: Point): number {
  let [nearest, least] = [-1, Infinity];
  for (let i = 0; i < rest.length; i += 3) {
    const distance = (rest[i] - x) ** 2 + (rest[i + 1] - y) ** 2 + (rest[i + 2] - z) ** 2;
    if (distance < least) [nearest, least] = [i / 3, distance];
  }
  return nearest;
}

/** Returns the distance of two points [m]. */
export function distanceBetween(a: Point, b: Point): number {
  return Math.hypot(a[0] - b[0], a[1] - b[1], a[2] - b[2]);
}

/**
 * Returns the angle at `corner` between the directions to `a` and to `b` [rad], 0 to pi; NaN if one of them is the
 * corner. From the tangent, atan2(|u x v|, u.v), which is exact near 0 and pi, where the cosine is flat.
 */
export function angleAt(corner: Point, a: Point, b: Point): number {
  const [u, v] = [a, b].map((end) => end.map((value, k) => value - corner[k]));
  if (Math.hypot(...u) === 0 || Math.hypot(...v) === 0) return NaN;
  const across = [u[1] * v[2] - u[2] * v[1], u[2] * v[0] - u[0] * v[2], u[0] * v[1] - u[1] * v[0]];
  return Math.atan2(Math.hypot(...across), u[0] * v[0] + u[1] * v[1] + u[2] * v[2]);
}

/** Returns the sum of the areas of the triangles, |u x v| / 2 each with their edges u, v [m^2]. */
export function surfaceArea(x: ArrayLike<number>, triangles: ArrayLike<number>): number {
  let twice = 0;
  for (let t = 0; t < triangles.length; t += 3) {
    const [a, b, c] = [3 * triangles[t], 3 * triangles[t + 1], 3 * triangles[t + 2]];
    const [ux, uy, uz] = [x[b] - x[a], x[b + 1] - x[a + 1], x[b + 2] - x[a + 2]];
    const [vx, vy, vz] = [x[c] - x[a], x[c + 1] - x[a + 1], x[c + 2] - x[a + 2]];
    twice += Math.hypot(uy * vz - uz * vy, uz * vx - ux * vz, ux * vy - uy * vx);
  }
  return twice / 2;
}

/**
 * Returns the volume that a closed surface encloses [m^3], positive if its triangles are counterclockwise seen from
 * outside. By the divergence theorem the volume is a third of the integral of x.n over the surface: the sum over the
 * triangles of a.(b x c) / 6. The positions are taken from the first vertex, so that a distant origin costs no digits.
 */
export function enclosedVolume(x: ArrayLike<number>, triangles: ArrayLike<number>): number {
  if (triangles.length === 0) return 0;
  const first = 3 * triangles[0];
  const [ox, oy, oz] = [x[first], x[first + 1], x[first + 2]];
  let six = 0;
  for (let t = 0; t < triangles.length; t += 3) {
    const [a, b, c] = [3 * triangles[t], 3 * triangles[t + 1], 3 * triangles[t + 2]];
    const [ax, ay, az] = [x[a] - ox, x[a + 1] - oy, x[a + 2] - oz];
    const [bx, by, bz] = [x[b] - ox, x[b + 1] - oy, x[b + 2] - oz];
    const [cx, cy, cz] = [x[c] - ox, x[c + 1] - oy, x[c + 2] - oz];
    six += ax * (by * cz - bz * cy) + ay * (bz * cx - bx * cz) + az * (bx * cy - by * cx);
  }
  return six / 6;
}

/**
 * True if the triangles enclose a volume: each edge has as many triangles in one direction as in the other. Vertices at
 * the same place, such as those along a seam, count as one.
 */
export function isClosed(x: ArrayLike<number>, triangles: ArrayLike<number>): boolean {
  const places = new Map<string, number>();
  const welded = Array.from({ length: x.length / 3 }, (_, i) => {
    const key = `${x[3 * i]} ${x[3 * i + 1]} ${x[3 * i + 2]}`;
    const place = places.get(key) ?? places.size;
    places.set(key, place);
    return place;
  });
  const balance = new Map<number, number>();
  for (let i = 0; i < triangles.length; i++) {
    const [a, b] = [welded[triangles[i]], welded[triangles[i % 3 === 2 ? i - 2 : i + 1]]];
    const edge = Math.min(a, b) * places.size + Math.max(a, b);
    balance.set(edge, (balance.get(edge) ?? 0) + Math.sign(b - a));
  }
  return triangles.length > 0 && [...balance.values()].every((each) => each === 0);
}
