// Numbers on the wire are little-endian (proto/README.md); typed arrays have the byte order of the machine.
const machineIsLittleEndian = new Uint8Array(new Uint16Array([1]).buffer)[0] === 1;

/**
 * Returns an aligned copy of 4-byte numbers in machine order. Throws RangeError, naming `what`, if the length is not a
 * multiple of `group` numbers.
 */
function aligned(bytes: Uint8Array, group: number, what: string): ArrayBuffer {
  if (bytes.byteLength % (4 * group) !== 0) {
    throw new RangeError(`${what}: ${bytes.byteLength} bytes are not a multiple of ${4 * group}.`);
  }
  const copy = bytes.slice();
  if (!machineIsLittleEndian) {
    const view = new DataView(copy.buffer);
    for (let i = 0; i < copy.byteLength; i += 4) view.setUint32(i, view.getUint32(i, false), true);
  }
  return copy.buffer;
}

/** Reads float32 in groups of `group`. Throws RangeError for incomplete groups. */
export function floats(bytes: Uint8Array, group: number, what: string): Float32Array<ArrayBuffer> {
  return new Float32Array(aligned(bytes, group, what));
}

/** Reads uint32 in groups of `group`. Throws RangeError for incomplete groups and for values of `count` or more. */
export function indices(bytes: Uint8Array, group: number, count: number, what: string): Uint32Array<ArrayBuffer> {
  const result = new Uint32Array(aligned(bytes, group, what));
  const bad = result.findIndex((index) => index >= count);
  if (bad >= 0) throw new RangeError(`${what}: index ${result[bad]} at ${bad}, but there are ${count} vertices.`);
  return result;
}
