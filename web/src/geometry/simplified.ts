import { MeshoptSimplifier } from "meshoptimizer/simplifier";

/** What the viewer uses of this module, which it loads only where it is needed. */
export interface Simplifier {
  simplified: typeof simplified;
}

/** What simplification may move a surface by [m], and the part of the triangles that it aims at. */
const allowedError = 0.0006;
const keptShare = 0.25;
/** Bodies with fewer triangles stay as they are. */
const fewTriangles = 300;

/**
 * Returns triangles over some of the same vertices, about a quarter as many, that follow the surface within 0.6 mm: by
 * meshoptimizer's edge collapse (quadric error). Open borders stay where they are.
 */
export async function simplified(
  rest: Float32Array,
  triangles: Uint32Array<ArrayBuffer>,
): Promise<Uint32Array<ArrayBuffer>> {
  if (triangles.length < 3 * fewTriangles || !MeshoptSimplifier.supported) return triangles;
  await MeshoptSimplifier.ready;
  const target = 3 * Math.floor((keptShare * triangles.length) / 3);
  const [fewer] = MeshoptSimplifier.simplify(triangles, rest, 3, target, allowedError, ["LockBorder", "ErrorAbsolute"]);
  return fewer as Uint32Array<ArrayBuffer>;
}
