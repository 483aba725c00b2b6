import { neighbourWeights, weightUnit } from "./neighbour_weights";
import type { RestShape } from "./rest_shape";
import { decompressExactly } from "./zstd";

const escapeCode = 3;
const headerBytes = 8;
const maxVarintBytes = 5;
const unitBits = Math.log2(weightUnit);

/** Predicts integers at vertices from the values of their neighbours. */
export interface NeighbourPredictor {
  /** The vertex at each position of the prediction order. */
  order: Int32Array;
  /** Replaces residuals by values in place: three per vertex, in prediction order. */
  addPredictions(values: Int32Array): void;
}

/** Creates the predictor of a mesh. */
export function neighbourPredictor(shape: RestShape): NeighbourPredictor {
  const { order, first, neighbours: neighbourList, weights } = neighbourWeights(shape);
  const neighbours = neighbourList.map((place) => 3 * place);
  const limit = largestExact(first, weights);
  const addPredictions = (values: Int32Array) => {
    const place = addIn32Bits(values, first, neighbours, weights, limit);
    if (place < order.length) addInDoubles(values, first, neighbours, weights, place);
  };
  return { order, addPredictions };
}

/** Returns the largest magnitude for which predictions cannot overflow 32 bits. */
function largestExact(first: Int32Array, weights: Int32Array): number {
  let most = 1;
  for (let place = 0; place + 1 < first.length; place++) {
    let sum = 0;
    for (let i = first[place]; i < first[place + 1]; i++) sum += Math.abs(weights[i]);
    most = Math.max(most, sum);
  }
  return Math.floor((2 ** 31 - weightUnit) / most);
}

/**
 * Predicts in 32-bit integers with local variables, since most of the decoding time is spent here. Stops after the
 * first vertex with a value above `limit`, and returns the next position in the order.
 */
function addIn32Bits(values: Int32Array, first: Int32Array, others: Int32Array, weights: Int32Array, limit: number) {
  for (let place = 0, own = 0; place + 1 < first.length; place++, own += 3) {
    let x = weightUnit / 2;
    let y = weightUnit / 2;
    let z = weightUnit / 2;
    const end = first[place + 1];
    for (let i = first[place]; i < end; i++) {
      const other = others[i];
      const weight = weights[i];
      x = (x + Math.imul(weight, values[other])) | 0;
      y = (y + Math.imul(weight, values[other + 1])) | 0;
      z = (z + Math.imul(weight, values[other + 2])) | 0;
    }
    x = (values[own] + (x >> unitBits)) | 0;
    y = (values[own + 1] + (y >> unitBits)) | 0;
    z = (values[own + 2] + (z >> unitBits)) | 0;
    values[own] = x;
    values[own + 1] = y;
    values[own + 2] = z;
    if (x > limit || x < -limit || y > limit || y < -limit || z > limit || z < -limit) return place + 1;
  }
  return first.length - 1;
}

/** Continues from position `start` for values of any size: sums stay below 2^53, so that doubles are exact. */
function addInDoubles(
  values: Int32Array,
  first: Int32Array,
  others: Int32Array,
  weights: Int32Array,
  start: number,
): void {
  for (let place = start; place + 1 < first.length; place++) {
    for (let axis = 0; axis < 3; axis++) {
      let sum = weightUnit / 2;
      for (let i = first[place]; i < first[place + 1]; i++) sum += weights[i] * values[others[i] + axis];
      values[3 * place + axis] += Math.floor(sum / weightUnit);
    }
  }
}

/** Decodes residuals, three per vertex. Throws RangeError if the bytes are not valid residuals (proto/README.md). */
export function readResiduals(bytes: Uint8Array, residuals: Int32Array): void {
  if (bytes.length < headerBytes) throw new RangeError("positions: the header is truncated.");
  const head = new DataView(bytes.buffer, bytes.byteOffset, bytes.byteLength);
  const end = headerBytes + head.getUint32(0, true);
  const size = head.getUint32(4, true);
  const count = residuals.length;
  if (end > bytes.length) throw new RangeError("positions: the packed residuals are truncated.");
  if (size > maxVarintBytes * count) throw new RangeError("positions: the overflow exceeds its maximum size.");
  const bits = decompressExactly(bytes.subarray(headerBytes, end), Math.ceil(count / 4));
  unpackResiduals(bits, decompressExactly(bytes.subarray(end), size), residuals);
}

/** Unpacks all x, then y, then z: two bits each, and a varint for values of `escapeCode`. */
function unpackResiduals(bits: Uint8Array, overflow: Uint8Array, residuals: Int32Array): void {
  const count = residuals.length;
  let at = 0;
  residuals.fill(0);
  for (let i = 0, to = 0; i < count; i += 4) {
    const four = bits[i >> 2];
    // Most values are 0; four of them share a byte.
    if (four === 0 && to + 12 < count) {
      to += 12;
      continue;
    }
    for (let shift = 0; shift < 8 && i + shift / 2 < count; shift += 2) {
      let value = (four >> shift) & 3;
      if (value === escapeCode) {
        let byte = 0x80;
        for (let bit = 0; byte >= 0x80; bit += 7) {
          if (at === overflow.length || bit === 35) throw new RangeError("positions: the overflow is truncated.");
          byte = overflow[at++];
          value += (byte & 0x7f) * 2 ** bit;
        }
      }
      residuals[to] = (value >>> 1) ^ -(value & 1);
      to += 3;
      if (to >= count) to -= count - 1; // the next axis
    }
  }
  if (at !== overflow.length) throw new RangeError("positions: there are unexpected bytes after the overflow.");
}
