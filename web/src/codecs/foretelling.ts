import { neighbourWeights, unit } from "./neighbour_weights";
import type { RestShape } from "./rest_shape";
import { unpack } from "./zstd";

const escape = 3;
const lengthBytes = 8;
const longestNumber = 5;

/** Foretells whole numbers at vertices from their neighbours'. */
export interface Foretelling {
  /** The vertex at each place. */
  order: Int32Array;
  /** From remainders to the numbers, in place: three a place. */
  add(values: Int32Array): void;
}

export function foretelling(shape: RestShape): Foretelling {
  const { order, first, places, weights } = neighbourWeights(shape);
  const others = places.map((place) => 3 * place);
  const doubles = Float64Array.from(weights);
  return { order, add: (values) => addForetold(values, first, others, doubles) };
}

/** Whole numbers below 2^53, so that doubles are exact; plain variables, as this is where the time goes. */
function addForetold(values: Int32Array, first: Int32Array, others: Int32Array, weights: Float64Array): void {
  const half = unit / 2;
  const part = 1 / unit;
  for (let place = 0, own = 0; place + 1 < first.length; place++, own += 3) {
    let x = half;
    let y = half;
    let z = half;
    const end = first[place + 1];
    for (let i = first[place]; i < end; i++) {
      const other = others[i];
      const weight = weights[i];
      x += weight * values[other];
      y += weight * values[other + 1];
      z += weight * values[other + 2];
    }
    values[own] += Math.floor(x * part);
    values[own + 1] += Math.floor(y * part);
    values[own + 2] += Math.floor(z * part);
  }
}

/** Remainders to `remainders`, three a place; RangeError where the bytes are no such remainders (proto/README.md). */
export function readRemainders(bytes: Uint8Array, remainders: Int32Array): void {
  if (bytes.length < lengthBytes) throw new RangeError("positions: the lengths are cut off.");
  const head = new DataView(bytes.buffer, bytes.byteOffset, bytes.byteLength);
  const end = lengthBytes + head.getUint32(0, true);
  const size = head.getUint32(4, true);
  const count = remainders.length;
  if (end > bytes.length) throw new RangeError("positions: the two bits are cut off.");
  if (size > longestNumber * count) throw new RangeError("positions: there is more overflow than there are numbers.");
  const bits = unpack(bytes.subarray(lengthBytes, end), Math.ceil(count / 4));
  join(bits, unpack(bytes.subarray(end), size), remainders);
}

/** All x first, from two bits each and what follows of those that are `escape`. */
function join(bits: Uint8Array, overflow: Uint8Array, remainders: Int32Array): void {
  const places = remainders.length / 3;
  let at = 0;
  for (let axis = 0, i = 0; axis < 3; axis++) {
    for (let place = 0; place < places; place++, i++) {
      let value = (bits[i >> 2] >> (2 * (i & 3))) & 3;
      if (value === escape) {
        let byte = 0x80;
        for (let shift = 0; byte >= 0x80; shift += 7) {
          if (at === overflow.length || shift === 35) throw new RangeError("positions: the overflow ends too early.");
          byte = overflow[at++];
          value += (byte & 0x7f) * 2 ** shift;
        }
      }
      remainders[3 * place + axis] = (value >>> 1) ^ -(value & 1);
    }
  }
  if (at !== overflow.length) throw new RangeError("positions: the overflow is too long.");
}
