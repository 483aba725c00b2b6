/** A vertex of a body. */
export interface VertexRef {
  body: string;
  vertex: number;
}

/** A coloured marker at a position [m]. */
export interface Marker {
  position: [number, number, number];
  color: string;
  /** True if a cut does not hide it: it is inside a body, where the cut is to show it. */
  unclipped?: boolean;
}
