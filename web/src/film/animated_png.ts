import { type Chunk, numbersChunk, readChunks, writeChunks } from "./png_chunks";

/**
 * Writes pictures of one canvas to an animated PNG that repeats for ever (PNG specification, third edition, W3C 2025).
 * The browser compresses each picture; its data become a frame of the file.
 */
export class AnimatedPngWriter {
  private readonly frames: Uint8Array[][] = [];
  private header: Chunk | undefined;

  private constructor(
    private readonly canvas: HTMLCanvasElement,
    private readonly rate: number,
  ) {}

  /** Returns a writer of animations of the canvas with `rate` pictures per second. */
  static open(canvas: HTMLCanvasElement, rate: number): AnimatedPngWriter {
    return new AnimatedPngWriter(canvas, rate);
  }

  /** Adds the canvas' picture as the next frame. Resolves when the page may draw the next. */
  async add(): Promise<void> {
    const picture = await new Promise<Blob | null>((done) => this.canvas.toBlob(done, "image/png"));
    if (picture === null) throw new Error("the browser has no memory for a picture");
    const chunks = readChunks(new Uint8Array(await picture.arrayBuffer()));
    this.header ??= chunks.find(({ type }) => type === "IHDR");
    this.frames.push(chunks.filter(({ type }) => type === "IDAT").map(({ data }) => data));
  }

  /** Returns the file. Throws Error without a frame. */
  finish(): Promise<Blob> {
    if (this.header === undefined) throw new Error("there is no frame");
    return Promise.resolve(writeChunks(animation(this.header, this.frames, this.canvas, this.rate)));
  }

  /** Ends without a file. */
  cancel(): void {
    this.frames.length = 0;
  }
}

/** Returns the chunks of an animation of pictures with this header; each picture is a list of its data. */
function animation(
  header: Chunk,
  pictures: Uint8Array[][],
  { width, height }: { width: number; height: number },
  rate: number,
): Chunk[] {
  let order = 0;
  // Whole pictures at the upper left corner, each shown for 1 / rate seconds, and replaced by the next.
  const control = () =>
    numbersChunk("fcTL", [
      [order++, 4],
      [width, 4],
      [height, 4],
      [0, 4],
      [0, 4],
      [1, 2],
      [rate, 2],
      [0, 1],
      [0, 1],
    ]);
  const data = (bytes: Uint8Array, first: boolean): Chunk => {
    if (first) return { type: "IDAT", data: bytes };
    const numbered = new Uint8Array(4 + bytes.length);
    new DataView(numbered.buffer).setUint32(0, order++);
    numbered.set(bytes, 4);
    return { type: "fdAT", data: numbered };
  };
  const frames = pictures.flatMap((parts, i) => [control(), ...parts.map((bytes) => data(bytes, i === 0))]);
  const forEver = 0;
  const count = numbersChunk("acTL", [[pictures.length, 4], [forEver, 4]]); // prettier-ignore
  return [header, count, ...frames, { type: "IEND", data: new Uint8Array(0) }];
}
