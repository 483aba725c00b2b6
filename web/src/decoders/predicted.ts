import { neighbourPredictor, readResiduals } from "./neighbour_predictor";
import type { PositionDecoder } from "./position_decoder";
import type { RestShape } from "./rest_shape";
import { checkStep, headerView } from "./zstd";

const headerBytes = 8;

/** Decodes CODEC_PREDICTED: residuals of displacements that are predicted from neighbours (proto/README.md). */
export function predictedDecoder(shape: RestShape): PositionDecoder {
  const { order, addPredictions } = neighbourPredictor(shape);
  const displacements = new Int32Array(shape.rest.length); // three per vertex; the buffer is reused, every frame overwrites it
  return (bytes) => {
    const step = checkStep(headerView(bytes, headerBytes).getFloat64(0, true));
    readResiduals(bytes.subarray(headerBytes), displacements);
    addPredictions(displacements);
    return displaced(shape.rest, order, displacements, step);
  };
}

function displaced(rest: Float32Array, order: Int32Array, displacements: Int32Array, step: number) {
  const positions = new Float32Array(rest.length);
  for (let i = 0, from = 0; i < order.length; i++, from += 3) {
    const to = 3 * order[i];
    positions[to] = rest[to] + step * displacements[from];
    positions[to + 1] = rest[to + 1] + step * displacements[from + 1];
    positions[to + 2] = rest[to + 2] + step * displacements[from + 2];
  }
  return positions;
}
