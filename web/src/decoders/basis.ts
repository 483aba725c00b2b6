import { neighbourPredictor, readResiduals } from "./neighbour_predictor";
import type { PositionDecoder } from "./position_decoder";
import type { RestShape } from "./rest_shape";
import { checkStep, headerView } from "./zstd";

const headerBytes = 16;
const noResiduals = 0;
const predictedResiduals = 2;

/**
 * Decodes CODEC_BASIS: a linear combination of basis shapes plus residuals of the vertices outside of the error bound
 * (proto/README.md).
 */
export function basisDecoder(shape: RestShape): PositionDecoder {
  const { rest, basisShapes } = shape;
  const { order, addPredictions } = neighbourPredictor(shape);
  const interleaved = interleave(basisShapes);
  const coefficients = new Float64Array(basisShapes.length);
  const sum = new Float64Array(rest.length); // both buffers are reused; every frame overwrites them
  const residuals = new Int32Array(rest.length);
  return (bytes) => {
    const header = headerView(bytes, headerBytes + 4 * basisShapes.length);
    const step = checkStep(header.getFloat64(0, true));
    if (header.getUint32(8, true) !== basisShapes.length)
      throw new RangeError("positions: the number of shapes does not match the basis.");
    const kind = header.getUint32(12, true);
    const residualBytes = bytes.subarray(headerBytes + 4 * basisShapes.length);
    if (kind > predictedResiduals || (kind === noResiduals && residualBytes.length > 0))
      throw new RangeError("positions: there are unexpected bytes after the coefficients.");
    for (let k = 0; k < coefficients.length; k++)
      coefficients[k] = checkCoefficient(header.getFloat32(headerBytes + 4 * k, true));
    addShapes(rest, coefficients, interleaved, sum);
    if (kind !== noResiduals) {
      readResiduals(residualBytes, residuals);
      if (kind === predictedResiduals) addPredictions(residuals);
      for (let i = 0, from = 0; i < order.length; i++, from += 3) {
        const to = 3 * order[i];
        sum[to] += step * residuals[from];
        sum[to + 1] += step * residuals[from + 1];
        sum[to + 2] += step * residuals[from + 2];
      }
    }
    return checkFinite(new Float32Array(sum));
  };
}

/** Interleaves the shapes by coordinate, so that one pass over memory adds all of them. */
function interleave(shapes: Float32Array[]): Float32Array {
  const result = new Float32Array(shapes.length * (shapes[0]?.length ?? 0));
  shapes.forEach((shape, k) => shape.forEach((value, i) => (result[i * shapes.length + k] = value)));
  return result;
}

function checkCoefficient(part: number): number {
  if (!Number.isFinite(part)) throw new RangeError("positions: a coefficient is not finite.");
  return part;
}

function addShapes(rest: Float32Array, coefficients: Float64Array, interleaved: Float32Array, sum: Float64Array): void {
  for (let i = 0, at = 0; i < sum.length; i++) {
    let x = rest[i];
    for (let k = 0; k < coefficients.length; k++) x += coefficients[k] * interleaved[at++];
    sum[i] = x;
  }
}

function checkFinite(positions: Float32Array<ArrayBuffer>): Float32Array<ArrayBuffer> {
  let all = 0; // stays 0 unless a number is infinite or NaN
  for (let i = 0; i < positions.length; i++) all += 0 * positions[i];
  if (all !== 0) throw new RangeError("positions: a number is not finite.");
  return positions;
}

/** Decodes the shapes of a basis, encoded as CODEC_PREDICTED, into displacements from rest [m]. */
export function decodeShapes(rest: Float32Array, predicted: PositionDecoder, encoded: Uint8Array[]): Float32Array[] {
  return encoded.map((bytes) => predicted(bytes).map((x, i) => x - rest[i]));
}
