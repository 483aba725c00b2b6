import type { Decoder } from "./decoder";
import { type NeighbourWeights, neighbourWeights, unit } from "./neighbour_weights";
import type { RestShape } from "./rest_shape";
import { checkStep, unpack, viewOf } from "./zstd";

const headBytes = 16;
const escape = 3;
const longestNumber = 5;

/** What is left of displacements after they are foretold from their neighbours' (proto/README.md). */
export function predictedDecoder(shape: RestShape): Decoder {
  const neighbours = neighbourWeights(shape);
  const count = shape.rest.length;
  const displacements = new Int32Array(count); // three a place; kept, as it is written anew each time
  return (bytes) => {
    const head = viewOf(bytes, headBytes);
    const step = checkStep(head.getFloat64(0, true));
    const end = headBytes + head.getUint32(8, true);
    const size = head.getUint32(12, true);
    if (end > bytes.length) throw new RangeError("positions: the two bits are cut off.");
    if (size > longestNumber * count) throw new RangeError("positions: there is more overflow than there are numbers.");
    const bits = unpack(bytes.subarray(headBytes, end), Math.ceil(count / 4));
    join(bits, unpack(bytes.subarray(end), size), displacements);
    foretell(neighbours, displacements);
    return place(shape.rest, neighbours.order, displacements, step);
  };
}

/** Remainders, all x first, from two bits each and what follows of those that are `escape`; three a place. */
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

/** From remainders to displacements, in place: whole numbers below 2^53, so that doubles are exact. */
function foretell({ first, places, weights }: NeighbourWeights, values: Int32Array): void {
  for (let place = 0; place + 1 < first.length; place++) {
    let [x, y, z] = [unit / 2, unit / 2, unit / 2];
    for (let i = first[place]; i < first[place + 1]; i++) {
      const other = 3 * places[i];
      const weight = weights[i];
      x += weight * values[other];
      y += weight * values[other + 1];
      z += weight * values[other + 2];
    }
    const own = 3 * place;
    values[own] += Math.floor(x / unit);
    values[own + 1] += Math.floor(y / unit);
    values[own + 2] += Math.floor(z / unit);
  }
}

function place(rest: Float32Array, order: Int32Array, displacements: Int32Array, step: number) {
  const positions = new Float32Array(rest.length);
  for (let i = 0; i < order.length; i++) {
    const to = 3 * order[i];
    for (let axis = 0; axis < 3; axis++) positions[to + axis] = rest[to + axis] + step * displacements[3 * i + axis];
  }
  return positions;
}
