import type { RestShape } from "./rest_shape";

/**
 * An order of the vertices in which each is predicted from previous ones, and the weights of this prediction, bit for
 * bit equal to server/stream/neighbour_weights.h.
 */
export interface NeighbourWeights {
  /** The vertex at each position of the order. */
  order: Int32Array;
  /** Start of each position's range in `neighbours` and `weights`, and the end of the last one. */
  first: Int32Array;
  neighbours: Int32Array;
  /** Fixed-point weights in units of 1/4096; they sum to 4096. */
  weights: Int32Array;
}

/** The weight 1 in fixed-point numbers. */
export const weightUnit = 4096;
const maxNeighbours = 8;
const regularisation = 0.03125;
const maxWeight = 4;

type Triple = [number, number, number];

/** Computes prediction order and weights of a mesh from its rest shape. */
export function neighbourWeights({ rest, neighbours: neighboursOf }: RestShape): NeighbourWeights {
  const order = breadthFirst(neighboursOf);
  const positions = new Int32Array(order.length);
  order.forEach((vertex, i) => (positions[vertex] = i));
  const first = new Int32Array(order.length + 1);
  const places: number[] = [];
  const weights: number[] = [];
  for (let i = 0; i < order.length; i++) {
    const chosen = chooseNeighbours(neighboursOf, positions, order[i]);
    if (chosen.length === 0 && i > 0) chosen.push(order[i - 1]);
    for (const vertex of chosen) places.push(positions[vertex]);
    if (chosen.length > 0) weights.push(...weightsOf(rest, order[i], chosen));
    first[i + 1] = places.length;
  }
  return { order, first, neighbours: Int32Array.from(places), weights: Int32Array.from(weights) };
}

/** Breadth-first order from the lowest vertex, with ascending neighbours. */
function breadthFirst(neighbours: number[][]): Int32Array {
  const order = new Int32Array(neighbours.length);
  const seen = new Uint8Array(neighbours.length);
  let count = 0;
  const visit = (vertex: number) => {
    if (seen[vertex] !== 0) return;
    seen[vertex] = 1;
    order[count++] = vertex;
  };
  for (let start = 0; start < neighbours.length; start++) {
    let next = count;
    visit(start);
    for (; next < count; next++) neighbours[order[next]].forEach(visit);
  }
  return order;
}

/** Returns neighbours that precede the vertex, then their neighbours, each once. */
function chooseNeighbours(neighbours: number[][], positions: Int32Array, vertex: number): number[] {
  const chosen: number[] = [];
  const add = (candidate: number) => {
    if (chosen.length === maxNeighbours || positions[candidate] >= positions[vertex]) return;
    if (!chosen.includes(candidate)) chosen.push(candidate);
  };
  neighbours[vertex].forEach(add);
  const near = chosen.length;
  for (let i = 0; i < near; i++) neighbours[chosen[i]].forEach(add);
  return chosen;
}

/** Solves (r I + sum d d^T) c = sum d for c by Cramer's rule, in the order of operations of the server. */
function fitLinear(offsets: Triple[]): Triple {
  let [xx, xy, xz, yy, yz, zz, x, y, z, furthest] = [0, 0, 0, 0, 0, 0, 0, 0, 0, 0];
  for (const [dx, dy, dz] of offsets) {
    xx += dx * dx;
    xy += dx * dy;
    xz += dx * dz;
    yy += dy * dy;
    yz += dy * dz;
    zz += dz * dz;
    x += dx;
    y += dy;
    z += dz;
    furthest = Math.max(furthest, dx * dx + dy * dy + dz * dz);
  }
  const r = regularisation * furthest;
  xx += r;
  yy += r;
  zz += r;
  const [cx, cy, cz] = [yy * zz - yz * yz, xz * yz - xy * zz, xy * yz - xz * yy];
  const determinant = xx * cx + xy * cy + xz * cz;
  if (!(determinant > 0)) return [0, 0, 0];
  const [ey, ez, ff] = [xx * zz - xz * xz, xy * xz - xx * yz, xx * yy - xy * xy];
  return [
    (cx * x + cy * y + cz * z) / determinant,
    (cy * x + ey * y + ez * z) / determinant,
    (cz * x + ez * y + ff * z) / determinant,
  ];
}

/** Returns weights in units of 1/4096; the first weight takes the rounding error. */
function weightsOf(rest: Float32Array, vertex: number, chosen: number[]): number[] {
  const along = (other: number, axis: number) => rest[3 * other + axis] - rest[3 * vertex + axis];
  const offsets = chosen.map((other): Triple => [along(other, 0), along(other, 1), along(other, 2)]);
  const [cx, cy, cz] = fitLinear(offsets);
  const weights = offsets.map(([dx, dy, dz]) => 1 - (dx * cx + dy * cy + dz * cz));
  const sum = weights.reduce((total, weight) => total + weight, 0);
  const wild = weights.some((weight) => !(Math.abs(weight) <= maxWeight * sum));
  const units = weights.map((weight) => Math.floor((wild ? 1 / weights.length : weight / sum) * weightUnit + 0.5));
  units[0] += weightUnit - units.reduce((total, each) => total + each, 0);
  return units;
}
