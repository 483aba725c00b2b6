/** A triangle surface: x y z per vertex [m], three vertex indices per triangle. */
export interface Surface {
  positions: Float32Array<ArrayBuffer>;
  triangles: Uint32Array<ArrayBuffer>;
}
