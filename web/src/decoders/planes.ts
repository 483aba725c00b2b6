import type { PositionDecoder } from "./position_decoder";
import type { RestShape } from "./rest_shape";
import { checkStep, decompressExactly, headerView } from "./zstd";

const headerBytes = 20;

/** Decodes CODEC_PLANES: 16 bits per coordinate, low and high bytes in separate compressed planes (proto/README.md). */
export function planesDecoder({ rest }: RestShape): PositionDecoder {
  const count = rest.length;
  return (bytes) => {
    const head = headerView(bytes, headerBytes);
    const step = checkStep(head.getFloat64(0, true));
    const planes = decompressExactly(bytes.subarray(headerBytes), 2 * count);
    const positions = new Float32Array(count);
    const vertices = count / 3;
    for (let axis = 0, place = 0; axis < 3; axis++) {
      const corner = head.getFloat32(8 + 4 * axis, true);
      if (!Number.isFinite(corner)) throw new RangeError("positions: the corner is not finite.");
      for (let i = 0; i < vertices; i++, place++) {
        positions[3 * i + axis] = corner + step * (planes[place] + 256 * planes[place + count]);
      }
    }
    return positions;
  };
}
