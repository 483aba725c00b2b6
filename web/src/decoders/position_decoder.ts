/** Positions, x y z a vertex [m], from a frame's bytes; RangeError where they are no encoding of so many vertices. */
export type PositionDecoder = (bytes: Uint8Array) => Float32Array<ArrayBuffer>;
