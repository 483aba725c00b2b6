import { floats } from "../geometry/wire_arrays";
import type { PositionDecoder } from "./position_decoder";
import type { RestShape } from "./rest_shape";

/** Decodes CODEC_RAW: float32 positions. */
export function rawDecoder({ rest }: RestShape): PositionDecoder {
  return (bytes) => {
    const positions = floats(bytes, 3, "positions");
    if (positions.length !== rest.length)
      throw new RangeError(`positions: ${positions.length} numbers instead of ${rest.length}.`);
    return positions;
  };
}
