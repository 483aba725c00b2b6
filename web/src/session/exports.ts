import type { MessageInitShape } from "@bufbuild/protobuf";
import { Code, ConnectError } from "@connectrpc/connect";
import { type Api, errorText, unreachable } from "../connection/api";
import {
  type CreateExportRequestSchema,
  type Export,
  ExportState,
  ExportValues,
  type FileFormat,
} from "../gen/phrenic/v1/export_pb";
import { Signal } from "../state/signal";

/** What is exported, and how. */
export interface ExportChoices {
  format: string;
  /** Simulated time of the motion [s]. */
  seconds: number;
  /** Not set: the format's own. */
  framesPerSecond: number | undefined;
  values: ExportValues;
  /** Names; none: every deformable body. */
  bodies: string[];
}

export type ExportWork =
  | { kind: "idle" }
  | { kind: "recording"; file: string; done: number; secondsLeft: number | undefined }
  | { kind: "fetching"; file: string; done: number }
  | { kind: "ready"; file: string; size: number; url: string }
  | { kind: "failed"; words: string };

const attempts = 5;

/** Records a session's motion on the server and fetches the file; one export at a time. */
export class Exports {
  readonly formats = new Signal<FileFormat[]>([]);
  readonly work = new Signal<ExportWork>({ kind: "idle" });
  readonly choices = new Signal<ExportChoices>({
    format: "msh",
    seconds: 8,
    framesPerSecond: undefined,
    values: ExportValues.UNSPECIFIED,
    bodies: [],
  });
  private running = new AbortController();
  private job = "";

  constructor(
    private readonly api: Api,
    private readonly sessionId: string,
    private readonly pause = 1000,
  ) {}

  choose(choices: Partial<ExportChoices>): void {
    this.choices.set({ ...this.choices.value, ...choices });
  }

  get format(): FileFormat | undefined {
    return this.formats.value.find(({ name }) => name === this.choices.value.format);
  }

  /** Asks the server what it writes. */
  async learn(): Promise<void> {
    const answer = await this.api.exports.listFormats({}).catch(() => undefined);
    if (answer !== undefined) this.formats.set(answer.formats);
  }

  /** Records, and fetches the file; what ran or was there before is let go. */
  async start(): Promise<void> {
    this.stop();
    const { signal } = (this.running = new AbortController());
    this.work.set({ kind: "recording", file: "", done: 0, secondsLeft: undefined });
    try {
      const job = await this.record(signal);
      const file = await this.fetch(job, signal);
      if (signal.aborted) return;
      this.work.set({ kind: "ready", file: job.fileName, size: file.size, url: URL.createObjectURL(file) });
    } catch (error) {
      if (!signal.aborted) this.work.set({ kind: "failed", words: errorText(error) });
    } finally {
      await this.forget();
    }
  }

  /** Ends what runs, here and on the server, and lets go of a file that is ready. */
  stop(): void {
    this.running.abort();
    void this.forget();
    if (this.work.value.kind === "ready") URL.revokeObjectURL(this.work.value.url);
    this.work.set({ kind: "idle" });
  }

  private async forget(): Promise<void> {
    const exportId = this.job;
    this.job = "";
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
      seconds: format?.instant ? 0 : seconds,
      bodies: format?.numbersOnly ? [] : bodies,
    };
  }

  private async record(signal: AbortSignal): Promise<Export> {
    const created = await this.api.exports.createExport(this.request(), { signal });
    this.job = created.job!.id;
    for await (const { job } of this.api.exports.watchExport({ exportId: this.job }, { signal })) {
      if (job?.state === ExportState.DONE) return job;
      if (job?.state === ExportState.FAILED) throw new Error(job.problem);
      if (job === undefined || signal.aborted) continue;
      const { fileName: file, progress: done, secondsLeft } = job;
      this.work.set({ kind: "recording", file, done, secondsLeft });
    }
    throw new Error("the server ended the export without a file");
  }

  /** The file's bytes; a download that breaks off goes on where it was. */
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
          if (!signal.aborted) this.work.set({ kind: "fetching", file: job.fileName, done });
        }
        return new Blob(chunks);
      } catch (error) {
        if (attempt >= attempts || signal.aborted || !brokeOff(error)) throw error;
        await new Promise((resume) => setTimeout(resume, this.pause));
      }
    }
  }
}

/** Whether a stream ended on its way, rather than by the server's word. */
function brokeOff(error: unknown): boolean {
  return unreachable(error) || [Code.Unavailable, Code.Unknown].includes(ConnectError.from(error).code);
}
