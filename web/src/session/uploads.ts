import { type Api, errorText } from "../connection/api";
import type { SurfaceReport } from "../gen/phrenic/v1/inspect_pb";
import type { UploadKind } from "../gen/phrenic/v1/upload_pb";
import { Signal } from "../state/signal";

/** A file from the browser. */
export type LocalFile = Pick<File, "name" | "size" | "arrayBuffer">;

/** State of the upload; `done` is a fraction from 0 to 1, `path` names the file in scenes. */
export type UploadProgress =
  | { kind: "idle" }
  | { kind: "sending"; file: string; done: number }
  | { kind: "ready"; file: string; path: string; report: SurfaceReport | undefined }
  | { kind: "failed"; message: string };

const chunkBytes = 1 << 20;

/** Uploads surface files, one at a time; files that the server has already are not sent again. */
export class Uploads {
  /** Extensions of the file formats that the server reads, with dots. */
  readonly extensions = new Signal<string[]>([]);
  readonly progress = new Signal<UploadProgress>({ kind: "idle" });
  private latestUpload = 0;

  constructor(private readonly api: Api) {}

  /** Loads the list of file formats from the server. */
  async loadFormats(): Promise<void> {
    const answer = await this.api.uploads.listSurfaceFormats({}).catch(() => undefined);
    if (answer !== undefined) this.extensions.set(answer.formats.map(({ ending }) => ending));
  }

  /** Uploads a file; `progress` shows its state and the result. */
  async upload(file: LocalFile): Promise<void> {
    const turn = ++this.latestUpload;
    const show = (work: UploadProgress) => {
      if (turn === this.latestUpload) this.progress.set(work);
    };
    show({ kind: "sending", file: file.name, done: 0 });
    try {
      show(await this.send(file, (done) => show({ kind: "sending", file: file.name, done })));
    } catch (error) {
      show({ kind: "failed", message: errorText(error) });
    }
  }

  private async send(file: LocalFile, progress: (done: number) => void): Promise<UploadProgress> {
    const { name } = file;
    return { kind: "ready", file: name, ...(await sendFile(this.api, file, { name }, progress)) };
  }
}

/** Uploads a file under a name, in chunks; the report is that of a surface which the server did not have. */
export async function sendFile(
  api: Api,
  file: LocalFile,
  as: { name: string; kind?: UploadKind },
  progress: (done: number) => void,
): Promise<{ path: string; report: SurfaceReport | undefined }> {
  const content = new Uint8Array(await file.arrayBuffer());
  const begin = { ...as, size: BigInt(content.length), sha256: await sha256(content) };
  const begun = await api.uploads.beginUpload(begin);
  const { uploadId } = begun;
  if (uploadId === "") return { path: begun.file!.path, report: undefined };
  for (let at = Number(begun.received); at < content.length;) {
    const chunk = content.subarray(at, at + chunkBytes);
    at = Number((await api.uploads.addUploadChunk({ uploadId, offset: BigInt(at), chunk })).received);
    progress(at / content.length);
  }
  const finished = await api.uploads.finishUpload({ uploadId });
  return { path: finished.file!.path, report: finished.report };
}

/** Returns the digest in hexadecimal; empty if the page is not in a secure context (https or localhost). */
async function sha256(content: Uint8Array<ArrayBuffer>): Promise<string> {
  if (globalThis.crypto?.subtle === undefined) return "";
  const digest = new Uint8Array(await crypto.subtle.digest("SHA-256", content));
  return [...digest].map((byte) => byte.toString(16).padStart(2, "0")).join("");
}
