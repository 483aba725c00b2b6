/** A surface as bytes on the wire have it: x y z a vertex [m], three indices a triangle. */
export interface Surface {
  positions: Float32Array<ArrayBuffer>;
  triangles: Uint32Array<ArrayBuffer>;
}
