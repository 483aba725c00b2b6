import type { MessageInitShape } from "@bufbuild/protobuf";
import { Code, ConnectError } from "@connectrpc/connect";
import { type Api, errorText, isUnreachable } from "../connection/api";
import {
  type CreateExportRequestSchema,
  type Export,
  ExportState,
  ExportValues,
  type FileFormat,
} from "../gen/phrenic/v1/export_pb";
import { Signal } from "../state/signal";

/** Settings of an export. */
export interface ExportChoices {
  format: string;
  /** Simulated duration [s]. */
  seconds: number;
  /** Undefined for the default of the format. */
  framesPerSecond: number | undefined;
  values: ExportValues;
  /** Names of the bodies; empty for all deformable bodies. */
  bodies: string[];
}

/** State of the export; `done` is a fraction from 0 to 1, `size` in bytes. */
export type ExportProgress =
  | { kind: "idle" }
  | { kind: "recording"; file: string; done: number; secondsLeft: number | undefined }
  | { kind: "fetching"; file: string; done: number }
  | { kind: "filming"; file: string; done: number }
  | { kind: "ready"; file: string; size: number; url: string }
  | { kind: "failed"; message: string };

const maxAttempts = 5;

/** Records a session's motion on the server and downloads the file; one export at a time. */
export class Exports {
  readonly formats = new Signal<FileFormat[]>([]);
  readonly progress = new Signal<ExportProgress>({ kind: "idle" });
  readonly choices = new Signal<ExportChoices>({
    format: "msh",
    seconds: 8,
    framesPerSecond: undefined,
    values: ExportValues.UNSPECIFIED,
    bodies: [],
  });
  private running = new AbortController();
  private jobId = "";

  constructor(
    private readonly api: Api,
    private readonly sessionId: string,
    private readonly pause = 1000,
    /** Changes each file before it is offered. */
    private readonly finished: (file: Blob) => Blob | Promise<Blob> = (file) => file,
  ) {}

  /** Changes some settings of the next export. */
  choose(choices: Partial<ExportChoices>): void {
    this.choices.set({ ...this.choices.value, ...choices });
  }

  /** The selected format; undefined until the formats are loaded. */
  get format(): FileFormat | undefined {
    return this.formats.value.find(({ name }) => name === this.choices.value.format);
  }

  /** Loads the list of file formats from the server. */
  async loadFormats(): Promise<void> {
    const answer = await this.api.exports.listFormats({}).catch(() => undefined);
    if (answer !== undefined) this.formats.set(answer.formats);
  }

  /**
   * Records and downloads the file, and returns it; cancels a running export and releases a previous file. Returns
   * undefined if it fails or is stopped.
   */
  async start(): Promise<Blob | undefined> {
    this.stop();
    const { signal } = (this.running = new AbortController());
    this.progress.set({ kind: "recording", file: "", done: 0, secondsLeft: undefined });
    try {
      const job = await this.record(signal);
      const file = await this.finished(await this.fetch(job, signal));
      if (signal.aborted) return undefined;
      this.progress.set({ kind: "ready", file: job.fileName, size: file.size, url: URL.createObjectURL(file) });
      return file;
    } catch (error) {
      if (!signal.aborted) this.progress.set({ kind: "failed", message: errorText(error) });
      return undefined;
    } finally {
      await this.deleteJob();
    }
  }

  /** Cancels the export here and on the server, and releases the file. */
  stop(): void {
    this.running.abort();
    void this.deleteJob();
    if (this.progress.value.kind === "ready") URL.revokeObjectURL(this.progress.value.url);
    this.progress.set({ kind: "idle" });
  }

  private async deleteJob(): Promise<void> {
    const exportId = this.jobId;
    this.jobId = "";
    if (exportId !== "") await this.api.exports.deleteExport({ exportId }).catch(() => undefined);
  }

  private request(): MessageInitShape<typeof CreateExportRequestSchema> {
    const { seconds, bodies, ...rest } = this.choices.value;
    const format = this.format;
    const values = format !== undefined && format.values.length > 1 ? rest.values : ExportValues.UNSPECIFIED;
    return {
      ...rest,
      values,
      sessionId: this.sessionId,
      // A page plays one breath.
      seconds: format?.instant || format?.page ? 0 : seconds,
      bodies: format?.numbersOnly ? [] : bodies,
    };
  }

  private async record(signal: AbortSignal): Promise<Export> {
    const created = await this.api.exports.createExport(this.request(), { signal });
    this.jobId = created.job!.id;
    for await (const { job } of this.api.exports.watchExport({ exportId: this.jobId }, { signal })) {
      if (job?.state === ExportState.DONE) return job;
      if (job?.state === ExportState.FAILED) throw new Error(job.problem);
      if (job === undefined || signal.aborted) continue;
      const { fileName: file, progress: done, secondsLeft } = job;
      this.progress.set({ kind: "recording", file, done, secondsLeft });
    }
    throw new Error("the server ended the export without a file");
  }

  /** Downloads the file; resumes an interrupted download. */
  private async fetch(job: Export, signal: AbortSignal): Promise<Blob> {
    const chunks: Uint8Array<ArrayBuffer>[] = [];
    let offset = 0;
    for (let attempt = 1; ; ++attempt) {
      try {
        const request = { exportId: job.id, offset: BigInt(offset) };
        for await (const { chunk } of this.api.exports.downloadExport(request, { signal })) {
          chunks.push(chunk as Uint8Array<ArrayBuffer>);
          offset += chunk.length;
          const done = offset / Math.max(1, Number(job.bytes));
          if (!signal.aborted) this.progress.set({ kind: "fetching", file: job.fileName, done });
        }
        return new Blob(chunks);
      } catch (error) {
        if (attempt >= maxAttempts || signal.aborted || !isInterrupted(error)) throw error;
        await new Promise((resume) => setTimeout(resume, this.pause));
      }
    }
  }
}

/** True if the stream was interrupted rather than refused by the server. */
function isInterrupted(error: unknown): boolean {
  return isUnreachable(error) || [Code.Unavailable, Code.Unknown].includes(ConnectError.from(error).code);
}
