import type { Frame } from "../gen/phrenic/v1/frames_pb";
import type { Body, FrameArrays } from "../geometry/bodies";
import { type EncodedBasis, FrameDecoder } from "./frame_decoder";

/** Decodes the frames of one session, now or later. */
export interface Decoding {
  /** Forgets everything, for another scene. Frames that are being decoded are not reported. */
  start(bodies: Body[]): void;
  /** Adds a basis that later frames refer to. */
  addBasis(basis: EncodedBasis): void;
  /**
   * Reports the arrays of a frame to `done`, in the order of calls; undefined if the frame was dropped since decoding
   * is slower than frames arrive; or RangeError if it does not match the scene.
   */
  decode(frame: Frame, done: (result: FrameArrays | RangeError | undefined) => void): void;
}

/** Decodes at once, in the calling thread. */
export class ImmediateDecoding implements Decoding {
  private decoder: FrameDecoder;

  constructor(private readonly module: WebAssembly.Module) {
    this.decoder = new FrameDecoder(module, []);
  }

  start(bodies: Body[]): void {
    this.decoder = new FrameDecoder(this.module, bodies);
  }

  addBasis(basis: EncodedBasis): void {
    this.decoder.addBasis(basis);
  }

  decode(frame: Frame, done: (result: FrameArrays | RangeError) => void): void {
    let result: FrameArrays | RangeError;
    try {
      result = this.decoder.decode(frame);
    } catch (error) {
      if (!(error instanceof RangeError)) throw error;
      result = error;
    }
    done(result);
  }
}
