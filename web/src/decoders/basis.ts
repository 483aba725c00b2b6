import { foretelling, readRemainders } from "./neighbour_predictor";
import type { Decoder } from "./position_decoder";
import type { RestShape } from "./rest_shape";
import { checkStep, viewOf } from "./zstd";

const headBytes = 16;
const nothing = 0;
const foretold = 2;

/** A sum of shapes, and what is left of each vertex that it leaves outside the bound (proto/README.md). */
export function basisDecoder(shape: RestShape): Decoder {
  const { rest, shapes } = shape;
  const { order, add } = foretelling(shape);
  const side = sideBySide(shapes);
  const parts = new Float64Array(shapes.length);
  const sum = new Float64Array(rest.length); // both are kept, as they are written anew each time
  const steps = new Int32Array(rest.length);
  return (bytes) => {
    const head = viewOf(bytes, headBytes + 4 * shapes.length);
    const step = checkStep(head.getFloat64(0, true));
    if (head.getUint32(8, true) !== shapes.length) throw new RangeError("positions: of another number of shapes.");
    const kind = head.getUint32(12, true);
    const left = bytes.subarray(headBytes + 4 * shapes.length);
    if (kind > foretold || (kind === nothing && left.length > 0)) throw new RangeError("positions: too much follows.");
    for (let k = 0; k < parts.length; k++) parts[k] = finitePart(head.getFloat32(headBytes + 4 * k, true));
    sumUp(rest, parts, side, sum);
    if (kind !== nothing) {
      readRemainders(left, steps);
      if (kind === foretold) add(steps);
      for (let i = 0, from = 0; i < order.length; i++, from += 3) {
        const to = 3 * order[i];
        sum[to] += step * steps[from];
        sum[to + 1] += step * steps[from + 1];
        sum[to + 2] += step * steps[from + 2];
      }
    }
    return finite(new Float32Array(sum));
  };
}

/** The numbers of all shapes for a coordinate, one after the other, so that one pass takes them all. */
function sideBySide(shapes: Float32Array[]): Float32Array {
  const result = new Float32Array(shapes.length * (shapes[0]?.length ?? 0));
  shapes.forEach((shape, k) => shape.forEach((value, i) => (result[i * shapes.length + k] = value)));
  return result;
}

function finitePart(part: number): number {
  if (!Number.isFinite(part)) throw new RangeError("positions: a shape's part is not finite.");
  return part;
}

function sumUp(rest: Float32Array, parts: Float64Array, side: Float32Array, sum: Float64Array): void {
  for (let i = 0, at = 0; i < sum.length; i++) {
    let x = rest[i];
    for (let k = 0; k < parts.length; k++) x += parts[k] * side[at++];
    sum[i] = x;
  }
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
