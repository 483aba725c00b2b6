import { make } from "../../dom/elements";
import type { Exports } from "../../session/exports";
import { exportProgress, type FileMaking } from "./export_progress";
import { t } from "../../language/translate";

/**
 * Returns a row with a button that saves the next breath as a page that plays without a server. `exports` belongs to the
 * row.
 */
export function takeHomeRow(exports: Exports): HTMLElement {
  exports.choose({ format: "html", seconds: 0, bodies: [] });
  const title = t("Take this breath home");
  const go = make("button", { type: "button", id: "take-home", ariaLabel: t("Save: {0}", title) }, t("Save"));
  const progress = exportProgress(exports, go, "take-home");
  go.onclick = async () => {
    await exports.start();
    progress.querySelector("a")?.click();
  };
  const detail = t("One file that plays the next breath without a network: rotation, views, layers, graphs.");
  return make("li", {}, make("div", {}, make("b", {}, title), make("span", {}, detail), progress), go);
}

type Filming = FileMaking & { start(): Promise<void> };

/** Returns a row with a button that films the next breath, as a WebM file. */
export function filmRow(film: Filming): HTMLElement {
  const { go, progress } = filmButton(film);
  const detail = t(
    "A WebM video of the next breath as the view shows it, for slides: 25 pictures per simulated second.",
  );
  return make("li", {}, make("div", {}, make("b", {}, t(filmTitle)), make("span", {}, detail), progress), go);
}

const filmTitle = "A film of this breath";

/** Returns a button that makes and saves a film, and its progress. */
export function filmButton(film: Filming): { go: HTMLElement; progress: HTMLElement } {
  const go = make("button", { type: "button", id: "film", ariaLabel: t("Save: {0}", t(filmTitle)) }, t("Save"));
  const progress = exportProgress(film, go, "film");
  go.onclick = async () => {
    await film.start();
    progress.querySelector("a")?.click();
  };
  return { go, progress };
}
