import { decompress } from "fzstd";

/** The `size` bytes of a Zstandard frame; RangeError where it has others. */
export function decompressExactly(frame: Uint8Array, size: number): Uint8Array {
  if (size === 0) return new Uint8Array(0);
  let bytes: Uint8Array;
  try {
    bytes = decompress(frame, new Uint8Array(size));
  } catch (error) {
    throw new RangeError(`zstd: ${error instanceof Error ? error.message : String(error)}.`);
  }
  if (bytes.length !== size) throw new RangeError(`zstd: ${bytes.length} bytes instead of ${size}.`);
  return bytes;
}

/** A step of the grid on which positions lie [m]: above 0 and not above 1. */
export function checkStep(step: number): number {
  if (!(step > 0 && step <= 1)) throw new RangeError(`positions: the step, ${step} m, is not within 0 to 1 m.`);
  return step;
}

export function headerView(bytes: Uint8Array, head: number): DataView {
  if (bytes.length < head) throw new RangeError(`positions: ${bytes.length} bytes, less than the head's ${head}.`);
  return new DataView(bytes.buffer, bytes.byteOffset, bytes.byteLength);
}
