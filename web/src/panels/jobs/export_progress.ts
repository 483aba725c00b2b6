import { make } from "../../dom/elements";
import { alertMessage } from "../../dom/rows";
import type { ExportProgress, Exports } from "../../session/exports";

/**
 * Shows the progress and a link to the finished file; `start` is disabled while an export runs. The ids of the elements
 * begin with `id`.
 */
export function exportProgress(exports: Exports, start: HTMLButtonElement, id: string): HTMLElement {
  const place = make("div", { id: `${id}-progress` });
  exports.progress.subscribe((work) => {
    const running = work.kind === "recording" || work.kind === "fetching";
    start.disabled = running;
    place.replaceChildren(...progressElements(work, id, () => exports.stop()));
  });
  return place;
}

function progressElements(work: ExportProgress, id: string, stop: () => void): HTMLElement[] {
  if (work.kind === "idle") return [];
  if (work.kind === "failed") return [alertMessage(work.message)];
  if (work.kind === "ready") {
    const size = (work.size / 1e6).toFixed(1);
    return [make("a", { href: work.url, download: work.file, id: `${id}-link` }, `Save ${work.file} (${size} MB)`)];
  }
  const bar = make("progress", { max: 1, ariaLabel: "Progress of the export" });
  bar.value = work.done;
  const left =
    work.kind === "recording" && work.secondsLeft !== undefined ? `, ${work.secondsLeft.toFixed(0)} s left` : "";
  const words = make("p", { className: "faint" }, `${work.kind === "recording" ? "Recording" : "Fetching"}${left}…`);
  return [words, make("div", { className: "row" }, bar, make("button", { type: "button", onclick: stop }, "Stop"))];
}
