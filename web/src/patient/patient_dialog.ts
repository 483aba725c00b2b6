import type { Api } from "../connection/api";
import { make } from "../dom/elements";
import { alertMessage } from "../dom/rows";
import { type PatientReport, ReadinessVerdict } from "../gen/phrenic/v1/patient_pb";
import { fixed, t } from "../language/translate";
import { assumptionWords } from "./assumption_words";
import { findingWords, partName } from "./finding_words";
import { LabelTable } from "./label_table";
import { type Dropped, droppedFiles, type FoundFiles } from "./patient_files";
import { type ImportState, PatientImport } from "./patient_import";

const verdicts: Record<number, string> = {
  [ReadinessVerdict.READY]: "Ready: the volume shows what the model of a person needs.",
  [ReadinessVerdict.USABLE_WITH_CARE]: "Usable with care: parts of the model are guessed.",
  [ReadinessVerdict.NOT_USABLE]: "Not usable: the model would say nothing about this person.",
};

/** A dialog that makes a breathing patient of a segmentation. */
export class PatientDialog {
  readonly element = make("dialog", {
    className: "chooser",
    id: "patient",
    ariaLabel: t("A patient from a segmentation"),
  });
  private readonly content = make("div", { id: "patient-content" });
  private readonly status = make("div");
  private readonly importing: PatientImport;
  private labels: LabelTable | undefined;

  constructor(api: Api, open: (sessionId: string) => void) {
    this.importing = new PatientImport(api, open);
    const close = make("button", { type: "button", onclick: () => this.element.close() }, t("Close"));
    this.status.setAttribute("role", "status");
    this.element.append(
      make("header", {}, make("h2", {}, t("A patient from a segmentation")), close),
      this.content,
      this.status,
    );
    this.element.onclose = () => void this.importing.end();
    this.importing.state.subscribe((state) => this.show(state));
  }

  /** Opens the dialog, with what was dropped. */
  async start(dropped?: Dropped): Promise<void> {
    if (!this.element.isConnected) document.body.append(this.element);
    if (!this.element.open) this.element.showModal();
    if (dropped !== undefined) await this.importing.take(await droppedFiles(dropped));
  }

  private show(state: ImportState): void {
    this.content.replaceChildren();
    this.status.replaceChildren();
    if (state.kind === "empty") this.labels = undefined;
    if (state.kind === "empty") this.content.append(...this.pickers());
    else if (state.kind === "choosing") this.content.append(...this.choices(state.found), ...this.pickers());
    else if (state.kind === "naming")
      this.showTable(new LabelTable(state.table, (map) => void this.importing.readBy(map)));
    else if (state.kind === "made" || state.kind === "refused") this.content.append(...this.verdict(state));
    else if (state.kind === "failed") this.showFailure(state.message);
    else this.status.append(...this.progress(state));
  }

  private pickers(): HTMLElement[] {
    const picker = (id: string, words: string, folder: boolean) => {
      const input = make("input", { type: "file", hidden: true, id: `${id}-input`, multiple: true });
      input.webkitdirectory = folder;
      input.ariaLabel = words;
      input.onchange = () => void this.importing.take([...(input.files ?? [])]);
      return [input, make("button", { type: "button", id, onclick: () => input.click() }, words)];
    };
    const hint = t(
      "Lungs, ribs, vertebrae and organs of the thorax as NIfTI, DICOM Segmentation or RT Structure Set: one file, or several of one patient.",
    );
    const privacy = t(
      "Only the segmentation is sent to this server, no images. Of file names, only words such as “rib left 7” are sent. The server reads no patient names and deletes the file when this dialog closes.",
    );
    return [
      make("p", {}, hint),
      make("p", { className: "faint" }, privacy),
      make(
        "div",
        { className: "acts" },
        ...picker("patient-file", t("Choose files…"), false),
        ...picker("patient-folder", t("Choose a folder…"), true),
      ),
    ];
  }

  private choices({ volumes, unread, images, others }: FoundFiles): HTMLElement[] {
    const counts = t(
      "{0} segmentations, {1} other DICOM files, {2} other files; only what you choose is sent.",
      volumes.length,
      images,
      others,
    );
    const archives = unread.map(({ name }) =>
      alertMessage(
        t(
          "{0}: archives of this format are not read. Unpack it and choose the files or their folder, or pack them as .zip or .tar.",
          name,
        ),
      ),
    );
    if (volumes.length === 0) {
      const nothing = archives.length > 0 ? archives : [alertMessage(t("There is no segmentation among the files."))];
      return [...nothing, make("p", { className: "faint" }, counts)];
    }
    const all = make("button", { type: "button", id: "patient-all", className: "primary" });
    all.textContent = t("Open all {0} as one patient", volumes.length);
    all.title = t("Programs such as TotalSegmentator, MOOSE and CADS write a file for each structure or model");
    all.onclick = () => void this.importing.read(volumes);
    const rows = volumes.map((file) => {
      const words = make("div", {}, make("b", {}, file.name), make("span", {}, `${fixed(file.size / 1e6, 1)} MB`));
      const read = make("button", { type: "button", onclick: () => void this.importing.read([file]) }, t("Open"));
      read.ariaLabel = `${t("Open")}: ${file.name}`;
      return make("li", {}, words, read);
    });
    return [
      ...archives,
      make("p", { className: "faint" }, counts),
      make("div", { className: "acts" }, all),
      make("ul", { className: "label-rows" }, ...rows),
    ];
  }

  private showTable(labels: LabelTable): void {
    this.labels = labels;
    const go = make("button", { type: "button", id: "patient-make", className: "primary" }, t("Make the patient"));
    go.onclick = () => void this.make(false);
    this.content.append(labels.element, make("div", { className: "acts" }, go, this.cancelButton()));
    go.focus();
  }

  private async make(anyway: boolean): Promise<void> {
    if (this.labels !== undefined) await this.importing.make(this.labels.meanings(), anyway);
  }

  private progress(state: ImportState): HTMLElement[] {
    const done = state.kind === "sending" || state.kind === "making" ? state.done : undefined;
    const words = {
      sending: t("Sending the segmentation…"),
      reading: t("Reading the labels…"),
      opening: t("Compiling the scene…"),
      making: t("Making the patient: {0}", state.kind === "making" ? stepName(state.doing) : ""),
    }[state.kind as "sending"];
    const bar = make("progress", { max: 1, ariaLabel: t("Progress of the patient") });
    if (done !== undefined) bar.value = done;
    return [make("p", {}, words), bar, make("div", { className: "acts" }, this.cancelButton())];
  }

  private cancelButton(): HTMLElement {
    return make(
      "button",
      { type: "button", id: "patient-cancel", onclick: () => void this.importing.end() },
      t("Cancel"),
    );
  }

  private showFailure(message: string): void {
    this.status.append(alertMessage(message));
    if (this.labels !== undefined) this.content.append(this.namesButton());
    this.content.append(...this.pickers());
  }

  private namesButton(): HTMLElement {
    return make("button", { type: "button", id: "patient-names", onclick: () => this.rename() }, t("Change the names"));
  }

  private rename(): void {
    this.content.replaceChildren();
    this.status.replaceChildren();
    this.showTable(this.labels!);
  }

  private verdict(state: { kind: "made" | "refused"; report: PatientReport }): HTMLElement[] {
    const { readiness, diaphragm } = state.report;
    const verdict = readiness?.verdict ?? ReadinessVerdict.UNSPECIFIED;
    const heading = make("p", { id: "patient-verdict" }, make("b", {}, t(verdicts[verdict] ?? "")));
    heading.dataset.verdict = ReadinessVerdict[verdict];
    const reasons = (readiness?.findings ?? []).map((finding) => make("li", {}, findingWords(finding)));
    const parts: HTMLElement[] = [heading, make("ul", { id: "patient-reasons" }, ...reasons)];
    if (diaphragm !== undefined) {
      const shares = [diaphragm.areaCm2, 100 * diaphragm.extrapolated].map((value) => fixed(value, 0));
      parts.push(make("p", { className: "faint" }, t("Diaphragm: {0} cm², {1} % of it extrapolated.", ...shares)));
    }
    const assumed = assumptionWords(state.report);
    if (assumed.length > 0) {
      const items = assumed.map((words) => make("li", {}, words));
      parts.push(make("details", {}, make("summary", {}, t("What was assumed")), make("ul", {}, ...items)));
    }
    return [
      ...parts,
      make("div", { className: "acts" }, this.next(state.kind), this.namesButton(), this.cancelButton()),
    ];
  }

  private next(kind: "made" | "refused"): HTMLElement {
    if (kind === "made") {
      const open = () => void this.importing.openSession();
      return make(
        "button",
        { type: "button", id: "patient-open", className: "primary", onclick: open },
        t("Let the patient breathe"),
      );
    }
    const anyway = make("button", { type: "button", id: "patient-anyway" }, t("Make it nevertheless"));
    anyway.title = t("The model is made and shown, but says nothing about this person");
    anyway.onclick = () => void this.make(true);
    return anyway;
  }
}

/** Returns a step of the server, such as a body, in the page's language. */
function stepName(doing: string): string {
  if (doing === "reading") return t("reading the labels");
  return doing.startsWith("waiting") ? t("waiting for earlier patients") : partName(doing);
}
