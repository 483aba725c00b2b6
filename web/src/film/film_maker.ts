import { Clip } from "../frames/clip";
import type { OfflineMotion } from "../gen/phrenic/v1/offline_pb";
import { motionTitle } from "../parameters/presets";
import type { ExportProgress } from "../session/exports";
import { Signal } from "../state/signal";
import {
  animationRate,
  animationSize,
  filmLines,
  filmRate,
  filmSize,
  type FilmSize,
  filmTimes,
  usualLines,
} from "./layout";
import { type FilmStage, Pictures } from "./pictures";
import { t } from "../language/translate";

/** Takes the pictures of a film and makes its file. */
export interface PictureWriter {
  add(): Promise<void>;
  finish(): Promise<Blob>;
  cancel(): void;
}

/** Opens a writer of films of the canvas' size with `rate` frames per second. */
export type OpenWriter = (canvas: HTMLCanvasElement, rate: number) => Promise<PictureWriter>;

/** Where the motion of a film comes from. */
export interface MotionSource {
  /** Of the recording; "recording", "fetching" and "failed" are shown as those of the film. */
  progress: Signal<ExportProgress>;
  /** Returns the compiled decoder. */
  decoder(): Promise<WebAssembly.Module>;
  /** Returns the motion; undefined if it fails or is stopped. */
  record(): Promise<OfflineMotion | undefined>;
  stop(): void;
}

/** Ending of the file, pictures per second, and the largest size, if the user does not choose it. */
interface Format {
  extension: string;
  rate: number;
  size?: FilmSize;
}

/** The stages that draw a film now. */
const busy = new WeakSet<FilmStage>();

/**
 * Makes a film of a breath: the view draws its motion frame by frame at the film's rate, however long a drawing takes.
 * One film at a time.
 */
export class FilmMaker {
  readonly progress = new Signal<ExportProgress>({ kind: "idle" });
  /** Lines of pixels of the next film, and those that a user may choose; animated pictures have a fixed size. */
  lines = usualLines;
  readonly choices = filmLines;
  private running = new AbortController();

  constructor(
    private readonly source: MotionSource,
    private readonly stage: FilmStage,
    private readonly open: OpenWriter,
    private readonly supported: () => boolean = () => typeof VideoEncoder !== "undefined",
    private readonly format: Format = { extension: "webm", rate: filmRate },
  ) {
    source.progress.subscribe((work) => {
      if (["recording", "fetching", "failed"].includes(work.kind)) this.progress.set(work);
    });
  }

  /** Returns a maker of animated pictures (PNG), which every browser can make. */
  static ofAnimations(source: MotionSource, stage: FilmStage, open: OpenWriter): FilmMaker {
    const format = { extension: "png", rate: animationRate, size: animationSize };
    return new FilmMaker(source, stage, open, () => true, format);
  }

  /** Records and films a breath; cancels a film that is being made and releases the one before. */
  async start(): Promise<void> {
    this.stop();
    const { signal } = (this.running = new AbortController());
    const refusal = this.refusal();
    if (refusal !== undefined) return this.progress.set({ kind: "failed", message: refusal });
    try {
      const motion = await this.source.record();
      if (motion === undefined || signal.aborted) return;
      const file = `${motion.scene}.${this.format.extension}`;
      const film = await this.film(motion, file, signal);
      if (film === undefined || signal.aborted) return;
      const url = URL.createObjectURL(film);
      this.progress.set({ kind: "ready", file, size: film.size, url });
    } catch (error) {
      const reason = error instanceof Error ? error.message : String(error);
      if (!signal.aborted) this.progress.set({ kind: "failed", message: t("The film cannot be made: {0}.", reason) });
    }
  }

  /** Cancels the film, and releases the file. */
  stop(): void {
    this.running.abort();
    this.source.stop();
    if (this.progress.value.kind === "ready") URL.revokeObjectURL(this.progress.value.url);
    this.progress.set({ kind: "idle" });
  }

  private refusal(): string | undefined {
    if (busy.has(this.stage)) return t("Another film of this view is being made: wait for it, or stop it.");
    if (this.supported()) return this.stage.refusal();
    return t(
      "This browser has no video encoder (WebCodecs) here: use a current Chrome, Edge, Firefox or Safari, and open this page by https or on the server's own machine (localhost).",
    );
  }

  /** Returns the file; undefined if it is cancelled. */
  private async film(motion: OfflineMotion, file: string, signal: AbortSignal): Promise<Blob | undefined> {
    const clip = new Clip(await this.source.decoder(), motion.frames, motion.bodies);
    const { scene, preset } = motionTitle(motion);
    const title = preset === "" ? scene : `${scene} · ${preset}`;
    const size = this.format.size ?? filmSize(this.lines);
    const pictures = new Pictures(this.stage, { title, colors: this.stage.colors() }, size);
    const writer = await this.open(pictures.canvas, this.format.rate);
    pictures.begin();
    busy.add(this.stage);
    try {
      const times = filmTimes(clip.length, this.format.rate);
      for (const [i, time] of times.entries()) {
        pictures.take({ time: motion.frames[0].time + time, arrays: clip.at(time) }, time);
        await writer.add();
        if (signal.aborted) return undefined;
        this.progress.set({ kind: "filming", file, done: (i + 1) / times.length });
      }
      return await writer.finish();
    } finally {
      writer.cancel();
      busy.delete(this.stage);
      this.stage.end();
    }
  }
}
