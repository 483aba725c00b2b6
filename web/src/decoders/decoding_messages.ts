import type { FrameArrays } from "../geometry/bodies";
import { type DecodedBody, type EncodedBasis, type EncodedFrame, FrameDecoder } from "./frame_decoder";

/** What the page posts to the worker: a new scene, a basis of it, or a frame with the number of its answer. */
export type DecodingRequest =
  { bodies: DecodedBody[] } | { basis: EncodedBasis } | { number: number; frame: EncodedFrame };

/** What the worker posts for a frame. */
export type DecodingAnswer = { number: number } & (FrameArrays | { problem: string });

/**
 * Returns the function that answers requests in their order, once the decoder is loaded. A request after one that
 * failed since `load` did loads again.
 */
export function answerWith(load: () => Promise<WebAssembly.Module>) {
  let loading: Promise<WebAssembly.Module> | undefined = load();
  loading.catch(() => undefined); // the first request reports it
  let bodies: DecodedBody[] = [];
  /** Bases that the decoder does not have yet. */
  let bases: EncodedBasis[] = [];
  let decoder: FrameDecoder | undefined;
  return async (request: DecodingRequest): Promise<DecodingAnswer | undefined> => {
    try {
      if ("bodies" in request) {
        bodies = request.bodies;
        bases = [];
        decoder = undefined;
      }
      if ("basis" in request) bases.push(request.basis);
      loading ??= load();
      const module = await loading.catch((error: unknown) => {
        loading = undefined;
        throw error;
      });
      decoder ??= new FrameDecoder(module, bodies);
      for (const basis of bases.splice(0)) decoder.addBasis(basis);
      return "frame" in request ? { number: request.number, ...decoder.decode(request.frame) } : undefined;
    } catch (error) {
      if (!("frame" in request)) return undefined; // the frames of that scene or basis say what is wrong
      return { number: request.number, problem: error instanceof Error ? error.message : String(error) };
    }
  };
}
