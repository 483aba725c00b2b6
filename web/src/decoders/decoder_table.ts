import { Codec } from "../gen/phrenic/v1/frames_pb";
import { basisDecoder } from "./basis";
import { planesDecoder } from "./planes";
import { predictedDecoder } from "./predicted";
import { rawDecoder } from "./raw";
import type { RestShape } from "./rest_shape";

/** Positions, x y z a vertex [m], from a frame's bytes; RangeError where they are no encoding of so many vertices. */
export type Decoder = (bytes: Uint8Array) => Float32Array<ArrayBuffer>;

const decoders = new Map<Codec, (shape: RestShape) => Decoder>([
  [Codec.UNSPECIFIED, rawDecoder],
  [Codec.RAW, rawDecoder],
  [Codec.PLANES, planesDecoder],
  [Codec.PREDICTED, predictedDecoder],
  [Codec.BASIS, basisDecoder],
]);

export function makeDecoder(codec: Codec, shape: RestShape): Decoder {
  const make = decoders.get(codec);
  if (make === undefined) throw new RangeError(`codec: ${codec} is not known to this viewer.`);
  return make(shape);
}
