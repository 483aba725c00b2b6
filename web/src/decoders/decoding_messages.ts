import type { FrameArrays } from "../geometry/bodies";
import { type DecodedBody, type EncodedBasis, type EncodedFrame, FrameDecoder } from "./frame_decoder";

/** What the page posts to the worker: a new scene, a basis of it, or a frame with the number of its answer. */
export type DecodingRequest =
  { bodies: DecodedBody[] } | { basis: EncodedBasis } | { number: number; frame: EncodedFrame };

/** What the worker posts for a frame. */
export type DecodingAnswer = { number: number } & (FrameArrays | { problem: string });

/** Returns the function that answers requests in their order, once the decoder is loaded. */
export function answerWith(loading: Promise<WebAssembly.Module>) {
  let bodies: DecodedBody[] = [];
  let decoder: FrameDecoder | undefined;
  return async (request: DecodingRequest): Promise<DecodingAnswer | undefined> => {
    try {
      const module = await loading;
      if ("bodies" in request) {
        bodies = request.bodies;
        decoder = undefined;
      }
      decoder ??= new FrameDecoder(module, bodies);
      if ("basis" in request) decoder.addBasis(request.basis);
      return "frame" in request ? { number: request.number, ...decoder.decode(request.frame) } : undefined;
    } catch (error) {
      if (!("frame" in request)) return undefined; // the frames of that scene or basis say what is wrong
      return { number: request.number, problem: error instanceof Error ? error.message : String(error) };
    }
  };
}
