import { make } from "../../dom/elements";
import { alertMessage, loadOnOpen, section } from "../../dom/rows";
import type { SurfaceReport } from "../../gen/phrenic/v1/inspect_pb";
import type { UploadProgress, Uploads } from "../../session/uploads";
import { t } from "../../language/translate";

/** Uploads a surface file to the server, and shows its name for scenes and the report on the surface. */
export function uploadPanel(uploads: Uploads): HTMLElement {
  const file = make("input", { type: "file", id: "upload-file", hidden: true });
  file.ariaLabel = t("Surface file to upload");
  file.onchange = () => {
    const [chosen] = file.files ?? [];
    if (chosen !== undefined) void uploads.upload(chosen).finally(() => (file.value = ""));
  };
  const hint = make("p", { className: "faint" });
  uploads.extensions.subscribe((endings) => {
    file.accept = endings.join(",");
    hint.textContent = t("A surface ({0}) in millimetres, for scenes of any session.", endings.join(", "));
  });
  const open = make("button", { type: "button", id: "upload", onclick: () => file.click() }, t("Upload a surface…"));
  const place = make("div", { id: "upload-progress" });
  uploads.progress.subscribe((work) => place.replaceChildren(...progressElements(work)));
  return loadOnOpen(section(t("Surface files"), false, open, file, hint, place), () => uploads.loadFormats());
}

function progressElements(work: UploadProgress): HTMLElement[] {
  if (work.kind === "idle") return [];
  if (work.kind === "failed") return [alertMessage(work.message)];
  if (work.kind === "sending") {
    const bar = make("progress", { max: 1, value: work.done, ariaLabel: t("Progress of the upload") });
    return [make("p", { className: "faint" }, t("Sending {0}…", work.file)), bar];
  }
  const path = make("input", { type: "text", readOnly: true, value: work.path, id: "upload-path" });
  path.ariaLabel = t("Name of the file in scenes");
  path.onfocus = () => path.select();
  return [make("p", {}, t("{0} is uploaded. Its name in scenes:", work.file)), path, ...reported(work.report)];
}

function reported(report: SurfaceReport | undefined): HTMLElement[] {
  if (report === undefined) return [];
  const counts = t("{0} vertices, {1} triangles", String(report.vertices), String(report.triangles));
  const repairs = report.repairs.map((words) => make("li", {}, words));
  return [make("p", { className: "faint" }, counts), make("ul", { className: "faint" }, ...repairs)];
}
