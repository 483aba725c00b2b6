import { Codec, type Frame, type GetBasisResponse, Placement } from "../gen/phrenic/v1/frames_pb";
import { type Body, floatsPerPose, type FrameArrays } from "../geometry/bodies";
import { floats } from "../geometry/wire_arrays";
import { decodeShapes } from "./basis";
import { makeDecoder } from "./decoder_table";
import type { PositionDecoder } from "./position_decoder";
import { restShapeOf } from "./rest_shape";

/** Number of bases that are kept, since frames of the previous one may still arrive. */
const maxBases = 2;

/** Displacement shapes of all streamed bodies [m]. */
interface Basis {
  epoch: bigint;
  shapes: Float32Array[];
}

/** Decodes the frames of one scene into arrays. */
export class FrameDecoder {
  private readonly decoders = new Map<string, PositionDecoder>();
  private bases: Basis[] = [];

  /** `bodies` are indexed by their `body_index`. */
  constructor(private readonly bodies: Body[]) {}

  /** Adds a basis that later frames refer to. */
  addBasis({ epoch, shapes }: GetBasisResponse): void {
    const { rest, ...shape } = restShapeOf(this.streamed());
    const predicted = makeDecoder(Codec.PREDICTED, { rest, ...shape });
    this.bases = [{ epoch, shapes: decodeShapes(rest, predicted, shapes) }, ...this.bases].slice(0, maxBases);
    this.decoders.clear();
  }

  /**
   * Decodes a frame; bodies that it does not contain stay at rest. Throws RangeError if it does not match the scene.
   */
  decode(frame: Frame): FrameArrays {
    const present = frame.bodies.map((index) => this.bodies[index]);
    if (present.includes(undefined as never))
      throw new RangeError(`bodies: an index is out of range, there are ${this.bodies.length} bodies.`);
    const positions = this.decoderOf(frame, present)(frame.positions);
    return {
      positions: this.scatter(positions, present),
      poses: floats(frame.poses, floatsPerPose, "poses"),
    };
  }

  private decoderOf({ codec, bodies, basisEpoch }: Frame, present: Body[]): PositionDecoder {
    const key = `${codec}:${basisEpoch}:${bodies.join()}`;
    const cached = this.decoders.get(key);
    if (cached !== undefined) return cached;
    const shapes = codec === Codec.BASIS ? this.shapesOf(present, basisEpoch) : [];
    const decoder = makeDecoder(codec, restShapeOf(present, shapes));
    this.decoders.set(key, decoder);
    return decoder;
  }

  /** Returns the parts of the basis shapes that belong to these bodies. */
  private shapesOf(present: Body[], epoch: bigint): Float32Array[] {
    const basis = this.bases.find((each) => each.epoch === epoch);
    if (basis === undefined) throw new RangeError(`basis_epoch: the basis of epoch ${epoch} has not been received.`);
    return basis.shapes.map((shape) => {
      const parts = present.map(({ firstVertex, rest }) =>
        shape.subarray(3 * firstVertex, 3 * firstVertex + rest.length),
      );
      return Float32Array.from(parts.flatMap((part) => [...part]));
    });
  }

  private streamed(): Body[] {
    return this.bodies.filter((body) => body.placement === Placement.STREAMED);
  }

  /** Copies the positions of each body to its `firstVertex` among all streamed bodies. */
  private scatter(positions: Float32Array<ArrayBuffer>, present: Body[]): Float32Array<ArrayBuffer> {
    const streamed = this.streamed();
    if (present.length === streamed.length) return positions;
    const all = new Float32Array(streamed.reduce((count, body) => count + body.rest.length, 0));
    for (const body of streamed) all.set(body.rest, 3 * body.firstVertex);
    let first = 0;
    for (const { rest, firstVertex } of present) {
      all.set(positions.subarray(first, first + rest.length), 3 * firstVertex);
      first += rest.length;
    }
    return all;
  }
}
