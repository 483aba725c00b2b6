import type { Decoder } from "./decoder";
import { foretelling, readRemainders } from "./foretelling";
import type { RestShape } from "./rest_shape";
import { checkStep, viewOf } from "./zstd";

const headBytes = 16;
const nothing = 0;
const foretold = 2;

/** A sum of shapes, and what is left of each vertex that it leaves outside the bound (proto/README.md). */
export function basisDecoder(shape: RestShape): Decoder {
  const { rest, shapes } = shape;
  const { order, add } = foretelling(shape);
  const sum = new Float64Array(rest.length); // both are kept, as they are written anew each time
  const steps = new Int32Array(rest.length);
  return (bytes) => {
    const head = viewOf(bytes, headBytes + 4 * shapes.length);
    const step = checkStep(head.getFloat64(0, true));
    if (head.getUint32(8, true) !== shapes.length) throw new RangeError("positions: of another number of shapes.");
    const kind = head.getUint32(12, true);
    const left = bytes.subarray(headBytes + 4 * shapes.length);
    if (kind > foretold || (kind === nothing && left.length > 0)) throw new RangeError("positions: too much follows.");
    sum.set(rest);
    for (let k = 0; k < shapes.length; k++) addPart(sum, head.getFloat32(headBytes + 4 * k, true), shapes[k]);
    if (kind !== nothing) {
      readRemainders(left, steps);
      if (kind === foretold) add(steps);
      for (let i = 0; i < order.length; i++) {
        for (let axis = 0; axis < 3; axis++) sum[3 * order[i] + axis] += step * steps[3 * i + axis];
      }
    }
    return finite(new Float32Array(sum));
  };
}

function addPart(sum: Float64Array, part: number, shape: Float32Array): void {
  if (!Number.isFinite(part)) throw new RangeError("positions: a shape's part is not finite.");
  for (let i = 0; i < sum.length; i++) sum[i] += part * shape[i];
}

function finite(positions: Float32Array<ArrayBuffer>): Float32Array<ArrayBuffer> {
  let all = 0; // stays 0 unless a number is infinite or none
  for (let i = 0; i < positions.length; i++) all += 0 * positions[i];
  if (all !== 0) throw new RangeError("positions: a number is not finite.");
  return positions;
}

/** The shapes of a basis, as displacements from rest, from their encodings by CODEC_PREDICTED. */
export function decodeShapes(rest: Float32Array, predicted: Decoder, encoded: Uint8Array[]): Float32Array[] {
  return encoded.map((bytes) => predicted(bytes).map((x, i) => x - rest[i]));
}
