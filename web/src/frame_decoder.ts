import { type Body, floats, floatsPerPose, type FrameArrays } from "./codec";
import { type Decoder, makeDecoder } from "./codecs/decoder";
import { restShapeOf } from "./codecs/rest_shape";
import { type Frame, Placement } from "./gen/phrenic/v1/frames_pb";

/** Turns the frames of one scene into arrays. */
export class FrameDecoder {
  private readonly decoders = new Map<string, Decoder>();

  /** `bodies` by their `body_index`. */
  constructor(private readonly bodies: Body[]) {}

  /** RangeError where the frame does not fit the scene. Bodies that are not in it stay at rest. */
  decode(frame: Frame): FrameArrays {
    const present = frame.bodies.map((index) => this.bodies[index]);
    if (present.includes(undefined as never)) throw new RangeError(`bodies: there are only ${this.bodies.length}.`);
    const positions = this.decoderOf(frame, present)(frame.positions);
    return {
      positions: this.spread(positions, present),
      poses: floats(frame.poses, floatsPerPose, "poses"),
    };
  }

  private decoderOf({ codec, bodies }: Frame, present: Body[]): Decoder {
    const key = `${codec}:${bodies.join()}`;
    const decoder = this.decoders.get(key) ?? makeDecoder(codec, restShapeOf(present));
    this.decoders.set(key, decoder);
    return decoder;
  }

  /** Each body's part to where its `firstVertex` is among all streamed ones. */
  private spread(positions: Float32Array<ArrayBuffer>, present: Body[]): Float32Array<ArrayBuffer> {
    const streamed = this.bodies.filter((body) => body.placement === Placement.STREAMED);
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
