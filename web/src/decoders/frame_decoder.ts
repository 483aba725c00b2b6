import { Codec, type Frame, type GetBasisResponse, Placement } from "../gen/phrenic/v1/frames_pb";
import { type Body, floatsPerPose, type FrameArrays } from "../geometry/bodies";
import { floats } from "../geometry/wire_arrays";
import { WasmDecoder } from "./wasm_decoder";

/** Number of bases that are kept, since frames of the previous one may still arrive. */
const maxBases = 2;
/** Number of decoders that are kept, one for each set of bodies: the memory of a decoder never shrinks. */
const maxDecoders = 3;

/** What the decoder needs of a body, of a basis and of a frame: data that can be posted to a worker. */
export type DecodedBody = Pick<Body, "placement" | "rest" | "edges" | "triangles" | "firstVertex">;
export type EncodedBasis = Pick<GetBasisResponse, "epoch" | "shapes">;
export type EncodedFrame = Pick<Frame, "codec" | "bodies" | "basisEpoch" | "positions" | "poses">;

/** Displacement shapes of all streamed bodies [m]. */
interface Basis {
  epoch: bigint;
  shapes: Float32Array[];
}

/** Decodes the frames of one scene into arrays. */
export class FrameDecoder {
  private readonly decoders = new Map<string, WasmDecoder>();
  private bases: Basis[] = [];

  /** `module` is the compiled decoder; `bodies` are indexed by their `body_index`. */
  constructor(
    private readonly module: WebAssembly.Module,
    private readonly bodies: readonly DecodedBody[],
  ) {}

  /** Adds a basis that later frames refer to. Throws RangeError for shapes that are not valid. */
  addBasis({ epoch, shapes }: EncodedBasis): void {
    const streamed = this.streamed();
    const rest = restOf(streamed);
    const predicted = this.makeDecoder(streamed, []);
    const decoded = shapes.map((bytes) => predicted.decode(Codec.PREDICTED, bytes).map((x, i) => x - rest[i]));
    this.bases = [{ epoch, shapes: decoded }, ...this.bases].slice(0, maxBases);
    this.decoders.clear();
  }

  /**
   * Decodes a frame; bodies that it does not contain stay at rest. Throws RangeError if it does not match the scene.
   */
  decode(frame: EncodedFrame): FrameArrays {
    const present = frame.bodies.map((index) => this.bodies[index]);
    if (present.includes(undefined as never))
      throw new RangeError(`bodies: an index is out of range, there are ${this.bodies.length} bodies.`);
    const positions = this.decoderOf(frame, present).decode(frame.codec, frame.positions);
    return {
      positions: this.scatter(positions, present),
      poses: floats(frame.poses, floatsPerPose, "poses"),
    };
  }

  private decoderOf({ codec, bodies, basisEpoch }: EncodedFrame, present: DecodedBody[]): WasmDecoder {
    const key = `${codec === Codec.BASIS ? basisEpoch : ""}:${bodies.join()}`;
    const decoder =
      this.decoders.get(key) ??
      this.makeDecoder(present, codec === Codec.BASIS ? this.shapesOf(present, basisEpoch) : []);
    // In the order of their last use.
    this.decoders.delete(key);
    this.decoders.set(key, decoder);
    for (const oldest of [...this.decoders.keys()].slice(0, -maxDecoders)) this.decoders.delete(oldest);
    return decoder;
  }

  private makeDecoder(bodies: DecodedBody[], basisShapes: Float32Array[]): WasmDecoder {
    return new WasmDecoder(this.module, { rest: restOf(bodies), edges: edgesOf(bodies), basisShapes });
  }

  /** Returns the parts of the basis shapes that belong to these bodies. */
  private shapesOf(present: DecodedBody[], epoch: bigint): Float32Array[] {
    const basis = this.bases.find((each) => each.epoch === epoch);
    if (basis === undefined) throw new RangeError(`basis_epoch: the basis of epoch ${epoch} has not been received.`);
    return basis.shapes.map((shape) =>
      joined(
        present.map(({ firstVertex, rest }) => shape.subarray(3 * firstVertex, 3 * firstVertex + rest.length)),
        Float32Array,
      ),
    );
  }

  private streamed(): DecodedBody[] {
    return this.bodies.filter((body) => body.placement === Placement.STREAMED);
  }

  /** Copies the positions of each body to its `firstVertex` among all streamed bodies. */
  private scatter(positions: Float32Array<ArrayBuffer>, present: DecodedBody[]): Float32Array<ArrayBuffer> {
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

function restOf(bodies: DecodedBody[]): Float32Array<ArrayBuffer> {
  return joined(
    bodies.map(({ rest }) => rest),
    Float32Array,
  );
}

/** Returns the edges of the bodies or, if one has none, the sides of its triangles, with vertices of all bodies. */
function edgesOf(bodies: DecodedBody[]): Uint32Array {
  let first = 0;
  const parts = bodies.map(({ rest, edges, triangles }) => {
    const own = edges.length > 0 ? edges.slice() : sidesOf(triangles);
    for (let i = 0; i < own.length; i++) own[i] += first;
    first += rest.length / 3;
    return own;
  });
  return joined(parts, Uint32Array);
}

function sidesOf(triangles: Uint32Array): Uint32Array {
  const sides = new Uint32Array(2 * triangles.length);
  for (let i = 0; i < triangles.length; i++) {
    sides[2 * i] = triangles[i];
    sides[2 * i + 1] = triangles[i % 3 === 2 ? i - 2 : i + 1];
  }
  return sides;
}

function joined<T extends Float32Array<ArrayBuffer> | Uint32Array<ArrayBuffer>>(
  parts: (Float32Array | Uint32Array)[],
  Kind: new (length: number) => T,
): T {
  const all = new Kind(parts.reduce((count, part) => count + part.length, 0));
  let at = 0;
  for (const part of parts) {
    all.set(part, at);
    at += part.length;
  }
  return all;
}
