import { make } from "../../dom/elements";
import type { Exports } from "../../session/exports";
import { exportProgress, type FileMaking } from "./export_progress";

/**
 * Returns a row with a button that saves the next breath as a page that plays without a server. `exports` belongs to the
 * row.
 */
export function takeHomeRow(exports: Exports): HTMLElement {
  exports.choose({ format: "html", seconds: 0, bodies: [] });
  const title = "Take this breath home";
  const go = make("button", { type: "button", id: "take-home", ariaLabel: `Save: ${title}` }, "Save");
  const progress = exportProgress(exports, go, "take-home");
  go.onclick = async () => {
    await exports.start();
    progress.querySelector("a")?.click();
  };
  const detail = "One file that plays the next breath without a network: rotation, views, layers, graphs.";
  return make("li", {}, make("div", {}, make("b", {}, title), make("span", {}, detail), progress), go);
}

/** Returns a row with a button that films the next breath, as a WebM file. */
export function filmRow(film: FileMaking & { start(): Promise<void> }): HTMLElement {
  const title = "A film of this breath";
  const go = make("button", { type: "button", id: "film", ariaLabel: `Save: ${title}` }, "Save");
  const progress = exportProgress(film, go, "film");
  go.onclick = async () => {
    await film.start();
    progress.querySelector("a")?.click();
  };
  const detail = "A WebM video of the next breath as the view shows it, for slides: 25 pictures per simulated second.";
  return make("li", {}, make("div", {}, make("b", {}, title), make("span", {}, detail), progress), go);
}
