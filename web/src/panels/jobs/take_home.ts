import { make } from "../../dom/elements";
import { labelledRow } from "../../dom/rows";
import type { Exports } from "../../session/exports";
import { exportProgress, type FileMaking } from "./export_progress";
import { t } from "../../language/translate";

/**
 * Returns a row with a button that saves the next breath as a page that plays without a server. `exports` belongs to
 * the row.
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
  return fileRow(title, detail, go, progress);
}

type Filming = FileMaking & { start(): Promise<void> };
/** A film whose lines of pixels are among `choices`. */
type FilmOfLines = Filming & { lines: number; readonly choices: number[] };

/** Returns a row with a button that films the next breath, as a WebM file. */
export function filmRow(film: FilmOfLines): HTMLElement {
  const { go, lines, progress } = filmButton(film);
  const detail = t(
    "A WebM video of the next breath as the view shows it, for slides: 25 pictures per simulated second.",
  );
  return fileRow(t(filmTitle), detail, go, lines, progress);
}

/** Returns a row with a button that makes an animated picture of the next breath, as a PNG file. */
export function animationRow(film: Filming): HTMLElement {
  const { go, progress } = animationButton(film);
  const detail = t(
    "An animated PNG of the next breath, up to 480 pixels, for pages and messages: 10 pictures per simulated second.",
  );
  return fileRow(t(animationTitle), detail, go, progress);
}

const filmTitle = "A film of this breath";
const animationTitle = "An animated picture of this breath";

/** Returns a button that makes and saves a film, the choice of its size, and its progress. */
export function filmButton(film: FilmOfLines): { go: HTMLElement; lines: HTMLElement; progress: HTMLElement } {
  const select = make("select", { id: "film-lines" });
  select.append(...film.choices.map((lines) => make("option", { value: String(lines) }, String(lines))));
  select.value = String(film.lines);
  select.onchange = () => (film.lines = Number(select.value));
  const lines = labelledRow(select.id, t("Height [pixels]"), select);
  return { ...makingButton(film, "film", t(filmTitle)), lines };
}

/** Returns a button that makes and saves an animated picture, and its progress. */
export function animationButton(film: Filming): { go: HTMLElement; progress: HTMLElement } {
  return makingButton(film, "animation", t(animationTitle));
}

function makingButton(film: Filming, id: string, title: string): { go: HTMLElement; progress: HTMLElement } {
  const go = make("button", { type: "button", id, ariaLabel: t("Save: {0}", title) }, t("Save"));
  const progress = exportProgress(film, go, id);
  go.onclick = async () => {
    await film.start();
    progress.querySelector("a")?.click();
  };
  return { go, progress };
}

function fileRow(title: string, detail: string, go: HTMLElement, ...below: HTMLElement[]): HTMLElement {
  return make("li", {}, make("div", {}, make("b", {}, title), make("span", {}, detail), ...below), go);
}
