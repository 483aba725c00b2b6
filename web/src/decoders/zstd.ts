import { decompress } from "fzstd";

/** Decompresses a Zstandard frame. Throws RangeError if it does not contain exactly `size` bytes. */
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

/** Decompresses a Zstandard frame that states its size. Throws RangeError if it is damaged. */
export function decompressAll(frame: Uint8Array): Uint8Array {
  try {
    return decompress(frame);
  } catch (error) {
    throw new RangeError(`zstd: ${error instanceof Error ? error.message : String(error)}.`);
  }
}

/** Returns the quantisation step [m]. Throws RangeError unless it is above 0 and at most 1 m. */
export function checkStep(step: number): number {
  if (!(step > 0 && step <= 1))
    throw new RangeError(`positions: the quantisation step ${step} m is not between 0 and 1 m.`);
  return step;
}

/** Returns a view of the bytes. Throws RangeError if they are shorter than the header of `head` bytes. */
export function headerView(bytes: Uint8Array, head: number): DataView {
  if (bytes.length < head)
    throw new RangeError(`positions: ${bytes.length} bytes are fewer than the header of ${head}.`);
  return new DataView(bytes.buffer, bytes.byteOffset, bytes.byteLength);
}
