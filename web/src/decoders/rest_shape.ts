import type { Body } from "../geometry/bodies";

/** What server and viewer both know of the vertices that travel. */
export interface RestShape {
  /** x y z a vertex [m]. */
  rest: Float32Array;
  /** The vertices beside each, ascending, without itself. */
  neighbours: number[][];
  /** Displacements of all vertices, of which CODEC_BASIS puts frames together [m]. */
  basisShapes: Float32Array[];
}

/** Of these bodies, one after the other; edges as the server takes them: the body's own, else its triangles'. */
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
