/**
 * The server's decoder of frames, compiled to WebAssembly (server/stream/decoder/c_interface.h, web/decoder). Bytes of
 * any kind give positions or a RangeError; where the code traps, for lack of memory, the next call has a new instance.
 */
interface Exports {
  memory: WebAssembly.Memory;
  phrenic_allocate(size: number): number;
  phrenic_release(at: number): void;
  phrenic_decoder_make(rest: number, vertices: number, edges: number, edgeCount: number): number;
  phrenic_decoder_set_basis(decoder: number, shapes: number, count: number): number;
  phrenic_decoder_decode(decoder: number, codec: number, bytes: number, size: number, positions: number): number;
  phrenic_decompressed_size(bytes: number, size: number): number;
  phrenic_decompress(bytes: number, size: number, to: number, toSize: number): number;
}

/** What the codecs of frames refer to. */
export interface RestShape {
  /** Rest positions, x y z per vertex [m]. */
  rest: Float32Array;
  /** Pairs of neighbouring vertices; pairs may repeat. */
  edges: Uint32Array;
  /** Displacements of CODEC_BASIS for all vertices [m]. */
  basisShapes: Float32Array[];
}

/** One instance of the module, and functions that copy arrays to and from its memory. */
class Instance {
  readonly exports: Exports;

  constructor(module: WebAssembly.Module) {
    this.exports = new WebAssembly.Instance(module).exports as unknown as Exports;
  }

  /** Returns the address of a copy. */
  copyIn(from: Float32Array | Uint32Array | Uint8Array): number {
    const at = this.exports.phrenic_allocate(from.byteLength);
    this.bytes(at, from.byteLength).set(new Uint8Array(from.buffer, from.byteOffset, from.byteLength));
    return at;
  }

  /** A view of the memory, which is invalid after the next allocation. */
  bytes(at: number, size: number): Uint8Array<ArrayBuffer> {
    return new Uint8Array(this.exports.memory.buffer as ArrayBuffer, at, size);
  }

  /** Throws an error with the text at this address; returns if the address is 0. */
  check(at: number): void {
    if (at === 0) return;
    const text = new Uint8Array(this.exports.memory.buffer, at);
    throw new RangeError(`${new TextDecoder().decode(text.slice(0, text.indexOf(0)))}.`);
  }
}

/** Calls `work`; a trap of the module is thrown as a RangeError. */
function withoutTraps<T>(work: () => T): T {
  try {
    return work();
  } catch (error) {
    if (error instanceof RangeError) throw error;
    throw new RangeError(`decoder: ${error instanceof Error ? error.message : String(error)}.`);
  }
}

/** A decoder that is set up in an instance. */
class Decoder {
  private readonly instance: Instance;
  private readonly decoder: number;
  private readonly positions: number;
  private bytes = 0;
  private room = 0;

  constructor(
    module: WebAssembly.Module,
    private readonly shape: RestShape,
  ) {
    const instance = (this.instance = new Instance(module));
    const { rest, edges, basisShapes } = shape;
    const wasm = instance.exports;
    const [restAt, edgesAt] = [instance.copyIn(rest), instance.copyIn(edges)];
    this.decoder = wasm.phrenic_decoder_make(restAt, rest.length / 3, edgesAt, edges.length / 2);
    wasm.phrenic_release(edgesAt);
    if (this.decoder === 0) throw new RangeError("edges: there are too many, or one is of no vertex.");
    const shapesAt = wasm.phrenic_allocate(rest.byteLength * basisShapes.length);
    basisShapes.forEach((each, k) =>
      instance
        .bytes(shapesAt + k * rest.byteLength, rest.byteLength)
        .set(new Uint8Array(each.buffer, each.byteOffset, each.byteLength)),
    );
    instance.check(wasm.phrenic_decoder_set_basis(this.decoder, shapesAt, basisShapes.length));
    wasm.phrenic_release(shapesAt);
    this.positions = restAt; // of the same size, and copied by the decoder
  }

  decode(codec: number, bytes: Uint8Array): Float32Array<ArrayBuffer> {
    const { instance, shape } = this;
    const wasm = instance.exports;
    if (bytes.length > this.room || this.bytes === 0) {
      if (this.bytes !== 0) wasm.phrenic_release(this.bytes);
      this.room = 2 * bytes.length;
      this.bytes = wasm.phrenic_allocate(this.room);
    }
    instance.bytes(this.bytes, bytes.length).set(bytes);
    instance.check(wasm.phrenic_decoder_decode(this.decoder, codec, this.bytes, bytes.length, this.positions));
    return new Float32Array(instance.bytes(this.positions, shape.rest.byteLength).slice().buffer);
  }
}

/** Decodes positions of one rest shape. */
export class WasmDecoder {
  private decoder: Decoder | undefined;

  constructor(
    private readonly module: WebAssembly.Module,
    private readonly shape: RestShape,
  ) {}

  /**
   * Returns the positions of a frame, x y z per vertex [m]. Throws RangeError if the bytes are not a valid encoding by
   * the codec of this number.
   */
  decode(codec: number, bytes: Uint8Array): Float32Array<ArrayBuffer> {
    let refused = false;
    try {
      return withoutTraps(() => {
        this.decoder ??= new Decoder(this.module, this.shape);
        try {
          return this.decoder.decode(codec, bytes);
        } catch (error) {
          refused = error instanceof RangeError;
          throw error;
        }
      });
    } catch (error) {
      if (!refused) this.decoder = undefined; // an instance that trapped must not be used again
      throw error;
    }
  }
}

/** Largest decompressed file [bytes]; the size that it states is not trusted beyond. */
const maxDecompressed = 512 * 2 ** 20;

/** Decompresses a Zstandard frame that states its size. Throws RangeError if it is damaged. */
export function decompress(module: WebAssembly.Module, frame: Uint8Array): Uint8Array<ArrayBuffer> {
  return withoutTraps(() => {
    const instance = new Instance(module);
    const wasm = instance.exports;
    const from = instance.copyIn(frame);
    const size = wasm.phrenic_decompressed_size(from, frame.length);
    if (size < 0) throw new RangeError("zstd: the bytes are no frame, or one that does not state its size.");
    if (size > maxDecompressed) throw new RangeError(`zstd: ${size} bytes are more than ${maxDecompressed}.`);
    const to = wasm.phrenic_allocate(size);
    instance.check(wasm.phrenic_decompress(from, frame.length, to, size));
    return instance.bytes(to, size).slice();
  });
}
