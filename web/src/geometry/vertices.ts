/** A vertex of a body. */
export interface VertexRef {
  body: string;
  vertex: number;
}

/** A place to be marked, in a colour. */
export interface Marker {
  position: [number, number, number];
  color: string;
}
