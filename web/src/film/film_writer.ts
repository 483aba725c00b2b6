import { ArrayBufferTarget, Muxer } from "webm-muxer";

/** Encoded bits per second of 1280 x 720 pixels, frames from one key frame to the next, and frames that wait for the encoder at most. */
const usualBitrate = 4_000_000;
const keyInterval = 50;
const maxQueue = 4;
/** Codecs of WebM for the encoder and for the file, the better one first. */
const codecs = [
  { codec: "vp09.00.40.08", name: "V_VP9" },
  { codec: "vp8", name: "V_VP8" },
];

/** Encodes pictures of one canvas to a WebM file with a fixed rate. */
export class FilmWriter {
  private frames = 0;
  private fault: Error | undefined;

  private constructor(
    private readonly canvas: HTMLCanvasElement,
    private readonly rate: number,
    private readonly encoder: VideoEncoder,
    private readonly muxer: Muxer<ArrayBufferTarget>,
    onFault: { report: (error: Error) => void },
  ) {
    onFault.report = (error) => (this.fault = error);
  }

  /**
   * Returns a writer of films of the canvas' size with `rate` frames per second. Throws Error if the browser encodes
   * neither VP9 nor VP8.
   */
  static async open(canvas: HTMLCanvasElement, rate: number): Promise<FilmWriter> {
    const { width, height } = canvas;
    const bitrate = Math.round((usualBitrate * Math.max(width * height, 640 * 360)) / (1280 * 720));
    for (const { codec, name } of codecs) {
      const config: VideoEncoderConfig = { codec, width, height, bitrate, framerate: rate };
      const answer = await VideoEncoder.isConfigSupported(config).catch(() => undefined);
      if (answer?.supported !== true) continue;
      const video = { codec: name, width, height, frameRate: rate };
      const muxer = new Muxer({ target: new ArrayBufferTarget(), video });
      const onFault = { report: (_: Error) => undefined as void };
      const encoder = new VideoEncoder({
        output: (chunk, metadata) => muxer.addVideoChunk(chunk, metadata),
        error: (error) => onFault.report(error),
      });
      encoder.configure(config);
      return new FilmWriter(canvas, rate, encoder, muxer, onFault);
    }
    throw new Error("this browser encodes neither VP9 nor VP8: use a current Chrome, Edge or Firefox");
  }

  /** Adds the canvas' picture as the next frame. Resolves when the page may draw the next. Throws Error if it fails. */
  async add(): Promise<void> {
    const microseconds = (frames: number) => Math.round((1e6 * frames) / this.rate);
    const timestamp = microseconds(this.frames);
    const frame = new VideoFrame(this.canvas, { timestamp, duration: microseconds(this.frames + 1) - timestamp });
    this.encoder.encode(frame, { keyFrame: this.frames % keyInterval === 0 });
    frame.close();
    this.frames++;
    // Also lets the page show the progress and answer the user.
    do await new Promise((resume) => setTimeout(resume));
    while (this.encoder.encodeQueueSize > maxQueue && this.fault === undefined);
    if (this.fault !== undefined) throw this.fault;
  }

  /** Returns the file. Throws Error if a frame could not be encoded. */
  async finish(): Promise<Blob> {
    await this.encoder.flush();
    this.encoder.close();
    if (this.fault !== undefined) throw this.fault;
    this.muxer.finalize();
    return new Blob([this.muxer.target.buffer], { type: "video/webm" });
  }

  /** Ends without a file. */
  cancel(): void {
    if (this.encoder.state !== "closed") this.encoder.close();
  }
}
