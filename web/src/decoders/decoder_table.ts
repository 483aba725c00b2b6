import { Codec } from "../gen/phrenic/v1/frames_pb";
import { basisDecoder } from "./basis";
import { planesDecoder } from "./planes";
import type { PositionDecoder } from "./position_decoder";
import { predictedDecoder } from "./predicted";
import { rawDecoder } from "./raw";
import type { RestShape } from "./rest_shape";

const decoders = new Map<Codec, (shape: RestShape) => PositionDecoder>([
  [Codec.UNSPECIFIED, rawDecoder],
  [Codec.RAW, rawDecoder],
  [Codec.PLANES, planesDecoder],
  [Codec.PREDICTED, predictedDecoder],
  [Codec.BASIS, basisDecoder],
]);

/** Creates a decoder of positions. Throws RangeError for an unknown codec. */
export function makeDecoder(codec: Codec, shape: RestShape): PositionDecoder {
  const make = decoders.get(codec);
  if (make === undefined) throw new RangeError(`codec: ${codec} is not known to this viewer.`);
  return make(shape);
}
