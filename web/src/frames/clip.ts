import { fromBinary } from "@bufbuild/protobuf";
import { FrameDecoder } from "../decoders/frame_decoder";
import { decompress } from "../decoders/wasm_decoder";
import type { Frame } from "../gen/phrenic/v1/frames_pb";
import { type OfflineMotion, OfflineMotionSchema } from "../gen/phrenic/v1/offline_pb";
import { type Body, decodeBody, type FrameArrays } from "../geometry/bodies";
import { interpolate } from "./interpolation";

/** Decoded frames that are kept: the two around the displayed time, and one more. */
const keptFrames = 3;

/**
 * Returns the motion in the text of a page: Base64 of Zstandard of an OfflineMotion. `decoder` is the compiled decoder.
 * Throws RangeError if the text is no motion or has no frames.
 */
export function readMotion(decoder: WebAssembly.Module, text: string): OfflineMotion {
  const motion = fromBinary(OfflineMotionSchema, decompress(decoder, bytesOf(text)));
  if (motion.frames.length === 0) throw new RangeError("frames: the motion has no frames.");
  return motion;
}

/** Returns the text of the motion in the HTML of an exported page. Throws RangeError if the page has none. */
export function motionText(html: string): string {
  const text = /<script type="text\/plain" id="motion">([^<]*)</.exec(html)?.[1];
  if (text === undefined) throw new RangeError("motion: the exported page has no motion.");
  return text;
}

function bytesOf(text: string): Uint8Array {
  try {
    return Uint8Array.from(atob(text.trim()), (letter) => letter.charCodeAt(0));
  } catch {
    throw new RangeError("motion: the text is not Base64.");
  }
}

/** The bodies and frames of a motion, which is played in a loop. */
export class Clip {
  readonly bodies: Body[];
  /** Times of the frames from the first one on [s], ascending. */
  readonly times: number[];
  private readonly decoder: FrameDecoder;
  private readonly decoded = new Map<number, FrameArrays>();
  private shown: { time: number; arrays: FrameArrays } | undefined;

  /** `decoder` is the compiled decoder. Throws RangeError, naming the field, for bodies that are not valid. */
  constructor(
    decoder: WebAssembly.Module,
    private readonly frames: Frame[],
    bodies: OfflineMotion["bodies"],
  ) {
    this.bodies = bodies.map(decodeBody);
    this.times = frames.map(({ time }) => time - frames[0].time);
    this.decoder = new FrameDecoder(decoder, this.bodies);
  }

  /** Duration [s]. */
  get length(): number {
    return this.times[this.times.length - 1];
  }

  /** Returns the index of the frame that is displayed at `time`: the last one that is not later. */
  indexAt(time: number): number {
    return Math.max(
      0,
      this.times.findLastIndex((each) => each <= time + 1e-9),
    );
  }

  /** Returns the arrays at a time from 0 to `length` [s], interpolated. Equal times give the same object. */
  at(time: number): FrameArrays {
    if (this.shown?.time === time) return this.shown.arrays;
    const before = this.indexAt(time);
    const after = Math.min(before + 1, this.times.length - 1);
    const gap = this.times[after] - this.times[before];
    const part = gap > 0 ? (time - this.times[before]) / gap : 0;
    const arrays = interpolate(this.decode(before), this.decode(after), part);
    this.shown = { time, arrays };
    return arrays;
  }

  private decode(index: number): FrameArrays {
    const known = this.decoded.get(index);
    if (known !== undefined) return known;
    const arrays = this.decoder.decode(this.frames[index]);
    this.decoded.set(index, arrays);
    for (const oldest of this.decoded.keys()) {
      if (this.decoded.size <= keptFrames) break;
      this.decoded.delete(oldest);
    }
    return arrays;
  }
}
