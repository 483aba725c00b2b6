import { type Client, createClient } from "@connectrpc/connect";
import { type Api, errorText } from "../connection/api";
import type { LabelMeaning, PatientReport } from "../gen/phrenic/v1/patient_pb";
import { type InspectLabelsResponse, type Patient, PatientService, PatientState } from "../gen/phrenic/v1/patients_pb";
import { UploadKind } from "../gen/phrenic/v1/upload_pb";
import { sendFile } from "../session/uploads";
import { Signal } from "../state/signal";
import { neutralNames } from "./file_words";
import { findVolumes, type FoundFiles } from "./patient_files";
import { packTar } from "./tar";

/** State of the import; `done` is a fraction from 0 to 1. */
export type ImportState =
  | { kind: "empty" }
  | { kind: "choosing"; found: FoundFiles }
  | { kind: "sending"; done: number }
  | { kind: "reading" }
  | { kind: "naming"; table: InspectLabelsResponse }
  | { kind: "making"; done: number; doing: string }
  | { kind: "refused"; problem: string; report: PatientReport }
  | { kind: "made"; report: PatientReport }
  | { kind: "opening" }
  | { kind: "failed"; message: string };

/** Makes a patient's session from a label volume: sends it, asks what its labels are, and has the server make it. */
export class PatientImport {
  readonly state = new Signal<ImportState>({ kind: "empty" });
  private readonly patients: Client<typeof PatientService>;
  private path = "";
  private map = "";
  private patient: Patient | undefined;
  private running = new AbortController();

  constructor(
    private readonly api: Api,
    /** Opens a session in the page. */
    private readonly open: (sessionId: string) => void,
  ) {
    this.patients = createClient(PatientService, api.transport);
  }

  /**
   * Takes the volume among the files; if there are several, or none, shows what was found, for one or all to be read.
   */
  async take(files: File[]): Promise<void> {
    await this.end();
    const found = await findVolumes(files);
    if (found.volumes.length === 1 && found.unread.length === 0) return this.read(found.volumes);
    this.state.set({ kind: "choosing", found });
  }

  /**
   * Sends label files of one patient and has them read. Their names stay here: of several files the words are sent that
   * say what they show.
   */
  async read(files: File[]): Promise<void> {
    await this.end();
    await this.attempt(async (signal) => {
      this.state.set({ kind: "sending", done: 0 });
      const as = { name: "labels", kind: UploadKind.LABELS };
      const { path } = await sendFile(this.api, packed(files), as, (done) => {
        signal.throwIfAborted();
        this.state.set({ kind: "sending", done });
      });
      this.path = path;
      this.map = "";
      signal.throwIfAborted();
      await this.inspect(signal);
    });
  }

  /** Has the labels read by another program's map. */
  async readBy(map: string): Promise<void> {
    await this.attempt(async (signal) => {
      this.map = map;
      await this.inspect(signal);
    });
  }

  private async inspect(signal: AbortSignal): Promise<void> {
    this.state.set({ kind: "reading" });
    const table = await this.patients.inspectLabels({ path: this.path, map: this.map }, { signal });
    this.state.set({ kind: "naming", table });
  }

  /** Has the patient made of labels with these meanings, whose numbers are the volume's. */
  async make(labels: LabelMeaning[], anyway: boolean): Promise<void> {
    await this.attempt(async (signal) => {
      this.state.set({ kind: "making", done: 0, doing: "" });
      const { patient } = await this.patients.createPatient({ path: this.path, map: this.map, labels, anyway });
      this.patient = patient;
      if (signal.aborted) return void (await this.forgetPatient());
      for await (const { patient: now } of this.patients.watchPatient({ patientId: patient!.id }, { signal })) {
        this.patient = now!;
        this.showPatient(now!);
      }
    });
  }

  /** Creates and plays a session of the patient that was made, and opens it. */
  async openSession(): Promise<void> {
    await this.attempt(async () => {
      const scene = this.patient!.scene!;
      this.state.set({ kind: "opening" });
      const { session } = await this.api.sessions.createSession({
        source: { source: { case: "scene", value: scene } },
      });
      const sessionId = session!.id;
      await this.api.sessions.playSession({ sessionId });
      await this.end();
      this.open(sessionId);
    });
  }

  /** Stops what runs, and deletes the volume and the patient on the server. */
  async end(): Promise<void> {
    this.running.abort();
    this.state.set({ kind: "empty" });
    await this.forgetPatient();
    const { path } = this;
    this.path = "";
    if (path !== "") await this.api.uploads.deleteUpload({ path }).catch(() => undefined);
  }

  private showPatient({ state, progress, doing, problem, report }: Patient): void {
    const judged = report?.readiness !== undefined;
    if (state === PatientState.DONE) this.state.set({ kind: "made", report: report! });
    else if (state !== PatientState.FAILED) this.state.set({ kind: "making", done: progress, doing });
    else if (judged) this.state.set({ kind: "refused", problem, report: report! });
    else this.state.set({ kind: "failed", message: problem });
  }

  private async forgetPatient(): Promise<void> {
    const patientId = this.patient?.id;
    this.patient = undefined;
    if (patientId !== undefined) await this.patients.deletePatient({ patientId }).catch(() => undefined);
  }

  /** Runs a step; what it throws is shown, unless it was stopped. */
  private async attempt(step: (signal: AbortSignal) => Promise<void>): Promise<void> {
    this.running.abort();
    const running = new AbortController();
    this.running = running;
    try {
      await step(running.signal);
    } catch (error) {
      if (!running.signal.aborted) this.state.set({ kind: "failed", message: errorText(error) });
    }
  }
}

function packed(files: File[]): File {
  if (files.length === 1) return files[0];
  const names = neutralNames(files.map(({ name }) => name));
  return packTar(files.map((content, i) => ({ name: names[i], content })));
}
