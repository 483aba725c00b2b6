import { surfaceArea } from "../geometry/measuring";

/** Largest length of all open edges, in roots of the surface's area: a few triangles, not the rim of a sheet. */
const largestGap = 0.5;

/**
 * Returns the triangles of a surface, and those that close its small gaps: each edge then has as many triangles in one
 * direction as in the other, so that each ray leaves as often as it enters. A gap gets a fan from one of its vertices.
 * Undefined if the gaps are large: then the surface has no inside. Vertices at the same place count as one.
 */
export function closedTriangles(
  rest: Float32Array,
  triangles: Uint32Array<ArrayBuffer>,
): Uint32Array<ArrayBuffer> | undefined {
  const welded = weld(rest);
  const open = openEdges(triangles, welded);
  if (triangles.length === 0 || lengthOf(open, rest) > largestGap * Math.sqrt(surfaceArea(rest, triangles)))
    return undefined;
  const hub = hubs(open);
  const caps = open.flatMap(([from, to]) => {
    const centre = hub(from);
    return centre === from || centre === to ? [] : [to, from, centre];
  });
  return caps.length === 0 ? triangles : new Uint32Array([...triangles, ...caps]);
}

/** The first vertex at the place of each vertex. */
function weld(x: Float32Array): Uint32Array {
  const first = new Map<string, number>();
  return Uint32Array.from({ length: x.length / 3 }, (_, i) => {
    const key = `${x[3 * i]} ${x[3 * i + 1]} ${x[3 * i + 2]}`;
    const known = first.get(key) ?? i;
    first.set(key, known);
    return known;
  });
}

/** Edges that more triangles have in this direction than in the other, as often as that. */
function openEdges(triangles: Uint32Array, welded: Uint32Array): [from: number, to: number][] {
  const balance = new Map<number, number>();
  for (let i = 0; i < triangles.length; i++) {
    const [a, b] = [welded[triangles[i]], welded[triangles[i % 3 === 2 ? i - 2 : i + 1]]];
    const edge = Math.min(a, b) * welded.length + Math.max(a, b);
    balance.set(edge, (balance.get(edge) ?? 0) + Math.sign(b - a));
  }
  return [...balance].flatMap(([edge, count]) => {
    const [low, high] = [Math.floor(edge / welded.length), edge % welded.length];
    const directed: [number, number] = count > 0 ? [low, high] : [high, low];
    return Array.from({ length: Math.abs(count) }, () => directed);
  });
}

/** Returns a function from a vertex of open edges to one vertex of all that are connected with it. */
function hubs(open: [number, number][]): (vertex: number) => number {
  const parent = new Map<number, number>();
  const root = (vertex: number): number => {
    const above = parent.get(vertex) ?? vertex;
    return above === vertex ? vertex : root(above);
  };
  for (const [from, to] of open) {
    const [a, b] = [root(from), root(to)];
    parent.set(Math.max(a, b), Math.min(a, b));
  }
  return root;
}

function lengthOf(edges: [number, number][], x: Float32Array): number {
  return edges.reduce(
    (sum, [a, b]) => sum + Math.hypot(x[3 * a] - x[3 * b], x[3 * a + 1] - x[3 * b + 1], x[3 * a + 2] - x[3 * b + 2]),
    0,
  );
}
