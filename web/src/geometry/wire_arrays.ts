// Numbers on the wire are little-endian (proto/README.md), and typed arrays have the machine's order.
const machineIsLittleEndian = new Uint8Array(new Uint16Array([1]).buffer)[0] === 1;

/** Bytes of 4-byte numbers, copied so that they are aligned; `what` names them in errors. */
function aligned(bytes: Uint8Array, group: number, what: string): ArrayBuffer {
  if (bytes.byteLength % (4 * group) !== 0) {
    throw new RangeError(`${what}: ${bytes.byteLength} bytes are no multiple of ${4 * group}.`);
  }
  const copy = bytes.slice();
  if (!machineIsLittleEndian) {
    const view = new DataView(copy.buffer);
    for (let i = 0; i < copy.byteLength; i += 4) view.setUint32(i, view.getUint32(i, false), true);
  }
  return copy.buffer;
}

/** float32 in groups of `group`. */
export function floats(bytes: Uint8Array, group: number, what: string): Float32Array<ArrayBuffer> {
  return new Float32Array(aligned(bytes, group, what));
}

/** uint32 in groups of `group`, each below `count`. */
export function indices(bytes: Uint8Array, group: number, count: number, what: string): Uint32Array<ArrayBuffer> {
  const result = new Uint32Array(aligned(bytes, group, what));
  const bad = result.findIndex((index) => index >= count);
  if (bad >= 0) throw new RangeError(`${what}: index ${result[bad]} at ${bad}, but there are ${count} vertices.`);
  return result;
}
