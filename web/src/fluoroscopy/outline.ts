/** A closed surface [m]; triangles face outwards. */
export interface ClosedSurface {
  vertices: Float32Array<ArrayBuffer>;
  triangles: Uint32Array<ArrayBuffer>;
}

/** Distance of the skin from the bones' box on each side [m]. */
const margin = 0.018;
/** Distance of the rings [m], and how far above and below a ring its bones are [m]. */
const spacing = 0.02;
const reach = 0.1;
/** Rings beyond the lowest and above the highest bone [m], for abdomen and neck. */
const below = 0.1;
const above = 0.06;
/** Rings on either side that a ring is averaged with. */
const smoothing = 3;
const around = 64;
/** A superellipse |x/a|^p + |y/b|^p = 1: rounder than a box, fuller than an ellipse. */
const power = 2.5;

type Extents = [left: number, right: number, front: number, back: number];

/**
 * Returns the outline of the trunk around bones, in place of the skin that the scene lacks: horizontal superellipses 20
 * mm apart, each around the box of the bones within 100 mm of its height, smoothed, with 18 mm of tissue. Without arms,
 * shoulder blades and breasts. `server/fluoroscopy/outline.cc` computes the same. `bones` are their vertices [m], `low`
 * and `high` their heights at rest. Returns an empty surface without bones.
 */
export function trunkOutline(bones: Float32Array[], low: number, high: number): ClosedSurface {
  const first = low - below;
  const count = Math.max(2, Math.ceil((high + above - first) / spacing) + 1);
  const rings = filled(extentsAt(bones, first, count));
  if (rings === undefined) return { vertices: new Float32Array(), triangles: new Uint32Array() };
  const vertices = new Float32Array(3 * (count * around + 2));
  smoothed(rings).forEach((extents, k) => placeRing(vertices, k, first + k * spacing, extents));
  for (const [end, k] of [0, count - 1].entries()) placeCentre(vertices, count * around + end, k);
  return { vertices, triangles: triangles(count) };
}

function extentsAt(bones: Float32Array[], first: number, count: number): (Extents | undefined)[] {
  const all: (Extents | undefined)[] = Array.from({ length: count }, () => undefined);
  for (const points of bones) {
    for (let i = 0; i < points.length; i += 3) {
      const [x, y, z] = [points[i], points[i + 1], points[i + 2]];
      const from = Math.max(0, Math.ceil((z - reach - first) / spacing));
      const to = Math.min(count - 1, Math.floor((z + reach - first) / spacing));
      for (let k = from; k <= to; k++) {
        const e = (all[k] ??= [x, x, y, y]);
        if (x < e[0]) e[0] = x;
        if (x > e[1]) e[1] = x;
        if (y < e[2]) e[2] = y;
        if (y > e[3]) e[3] = y;
      }
    }
  }
  return all;
}

/** Gives rings without bones the extents of the nearest ring that has some. */
function filled(rings: (Extents | undefined)[]): Extents[] | undefined {
  const [begin, end] = [
    rings.findIndex((each) => each !== undefined),
    rings.findLastIndex((each) => each !== undefined),
  ];
  if (begin < 0) return undefined;
  let last = rings[begin]!;
  return rings.map((each, k) => (last = k > end ? rings[end]! : (each ?? last)));
}

function smoothed(rings: Extents[]): Extents[] {
  return rings.map((_, k) => {
    const [from, to] = [Math.max(0, k - smoothing), Math.min(rings.length - 1, k + smoothing)];
    const sum: Extents = [0, 0, 0, 0];
    for (let j = from; j <= to; j++) for (let e = 0; e < 4; e++) sum[e] += rings[j][e];
    return sum.map((each) => each / (to - from + 1)) as Extents;
  });
}

function placeRing(vertices: Float32Array, k: number, z: number, [left, right, front, back]: Extents): void {
  const [a, b] = [(right - left) / 2 + margin, (back - front) / 2 + margin];
  for (let i = 0; i < around; i++) {
    const angle = (2 * Math.PI * i) / around;
    const [c, s] = [Math.cos(angle), Math.sin(angle)];
    vertices.set([(left + right) / 2 + a * rounded(c), (front + back) / 2 + b * rounded(s), z], 3 * (k * around + i));
  }
}

const rounded = (part: number) => Math.sign(part) * Math.abs(part) ** (2 / power);

function placeCentre(vertices: Float32Array, vertex: number, k: number): void {
  for (let axis = 0; axis < 3; axis++) {
    let sum = 0;
    for (let i = 0; i < around; i++) sum += vertices[3 * (k * around + i) + axis];
    vertices[3 * vertex + axis] = sum / around;
  }
}

function triangles(count: number): Uint32Array<ArrayBuffer> {
  const all: number[] = [];
  const [bottom, top] = [count * around, count * around + 1];
  for (let i = 0; i < around; i++) {
    const next = (i + 1) % around;
    for (let k = 0; k + 1 < count; k++) {
      const [a, b, c, d] = [k * around + i, k * around + next, (k + 1) * around + i, (k + 1) * around + next];
      all.push(a, b, d, a, d, c);
    }
    all.push(bottom, next, i, top, (count - 1) * around + i, (count - 1) * around + next);
  }
  return new Uint32Array(all);
}
