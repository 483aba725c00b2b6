import type { Body } from "../geometry/bodies";

/** The mesh data that server and viewer share, which encodings refer to. */
export interface RestShape {
  /** Rest positions, x y z per vertex [m]. */
  rest: Float32Array;
  /** Neighbours of each vertex, ascending. */
  neighbours: number[][];
  /** Displacement shapes of CODEC_BASIS for all vertices [m]. */
  basisShapes: Float32Array[];
}

/** Concatenates the bodies. Edges are those of the body or, if it has none, of its triangles, as on the server. */
export function restShapeOf(bodies: Body[], basisShapes: Float32Array[] = []): RestShape {
  const rest = new Float32Array(bodies.reduce((count, body) => count + body.rest.length, 0));
  const sets: Set<number>[] = Array.from({ length: rest.length / 3 }, () => new Set<number>());
  let first = 0;
  for (const { rest: own, edges, triangles } of bodies) {
    rest.set(own, 3 * first);
    const join = (a: number, b: number) => {
      if (a === b) return;
      sets[first + a].add(first + b);
      sets[first + b].add(first + a);
    };
    for (let i = 0; i < edges.length; i += 2) join(edges[i], edges[i + 1]);
    for (let i = 0; edges.length === 0 && i < triangles.length; i += 3) {
      for (let k = 0; k < 3; k++) join(triangles[i + k], triangles[i + ((k + 1) % 3)]);
    }
    first += own.length / 3;
  }
  return { rest, neighbours: sets.map((set) => [...set].sort((a, b) => a - b)), basisShapes };
}
