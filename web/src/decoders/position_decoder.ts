/**
 * Decodes the bytes of a frame into positions, x y z per vertex [m]. Throws RangeError if the bytes are not a valid
 * encoding.
 */
export type PositionDecoder = (bytes: Uint8Array) => Float32Array<ArrayBuffer>;
