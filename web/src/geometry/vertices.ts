/** A vertex of a body. */
export interface VertexRef {
  body: string;
  vertex: number;
}

/** A coloured marker at a position [m]. */
export interface Marker {
  position: [number, number, number];
  color: string;
}
