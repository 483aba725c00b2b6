import { ColorScale, niceTop } from "../../appearance/color_scale";
import { make } from "../../dom/elements";
import { alertMessage, switchRow } from "../../dom/rows";
import type { Comparison, ComparisonProgress, Comparisons } from "../../session/comparisons";
import { Legend } from "../view/legend";
import { distanceTable } from "./distance_table";
import { fixed, t } from "../../language/translate";

/** A card with the progress and the result of a comparison, and its colour scale. */
export class ComparisonCard {
  readonly element = make("section", { id: "comparison", className: "card", ariaLabel: t("Distance to a surface") });
  private readonly progressElement = make("div", { className: "job" });
  private readonly resultElement = make("div", { className: "result" });
  private readonly timeNote = make("p", { className: "faint", id: "comparison-time" });
  private readonly legend = new Legend();
  private tableOpen = !matchMedia("(max-width: 760px)").matches;

  constructor(private readonly comparisons: Comparisons) {
    this.element.append(this.progressElement, this.resultElement);
    comparisons.progress.subscribe((work) => this.showProgress(work));
    comparisons.result.subscribe((result) => this.showResult(result));
  }

  /** Shows the current time of the session [s] if it differs from the compared one. */
  show(time: number | undefined): void {
    const result = this.comparisons.result.value;
    const elsewhere = result !== undefined && time !== undefined && time !== result.time;
    const now = t("at {0} s now", fixed(time ?? 0, 2));
    const follows = t("Colours show the session {0}; “Repeat” updates the table.", now);
    const words = elsewhere ? (result.surface === undefined ? t("The session is {0}.", now) : follows) : "";
    if (this.timeNote.textContent !== words) this.timeNote.textContent = words;
  }

  private showProgress(work: ComparisonProgress): void {
    this.progressElement.hidden = work.kind === "idle";
    this.updateVisibility();
    if (work.kind === "running") this.showRunning(work.file, work.done);
    if (work.kind === "failed") this.showFailure(work.message);
  }

  private showRunning(file: string, done: number): void {
    const bar = make("progress", { max: 1, ariaLabel: t("Progress of the comparison") });
    // A progress bar without a value is indeterminate.
    if (done > 0) bar.value = done;
    const stop = make("button", { type: "button", onclick: () => this.comparisons.stop() }, t("Stop"));
    const words = make("p", {}, t("Comparing with "), make("b", {}, file), "…");
    words.setAttribute("role", "status");
    this.progressElement.replaceChildren(words, make("div", { className: "row" }, bar, stop));
  }

  private showFailure(failure: string): void {
    const words = alertMessage(failure);
    const dismiss = make("button", { type: "button", onclick: () => this.comparisons.stop() }, t("Dismiss"));
    this.progressElement.replaceChildren(words, make("div", { className: "row" }, dismiss));
  }

  private showResult(result: Comparison | undefined): void {
    this.resultElement.hidden = result === undefined;
    this.timeNote.textContent = "";
    this.updateVisibility();
    if (result === undefined) return;
    this.legend.show(new ColorScale(niceTop(result.distances)));
    const figures = make(
      "details",
      { open: this.tableOpen },
      make("summary", {}, t("Distances")),
      distanceTable(result.distance),
    );
    figures.ontoggle = () => (this.tableOpen = figures.open);
    const warnings = result.warnings.map((warning) => alertMessage(warning));
    const rows = [...warnings, this.legend.element, this.timeNote, ...this.drawnRow(result), this.buttons(), figures];
    this.resultElement.replaceChildren(...this.heading(result), ...rows);
  }

  private drawnRow({ file, surface }: Comparison): HTMLElement[] {
    if (surface === undefined) return [];
    const { surfaceVisible } = this.comparisons;
    const { row, input } = switchRow(t("Show the surface"), t("{0}, yellow and translucent", file), (on) =>
      surfaceVisible.set(on),
    );
    input.id = "compare-drawn";
    input.checked = surfaceVisible.value;
    return [row];
  }

  private heading({ file, body, time, tick }: Comparison): HTMLElement[] {
    const when = t("{0} at {1} s, tick {2}", body, fixed(time, 3), String(tick));
    const words = make("p", { className: "faint", id: "comparison-when" }, when);
    return [make("h2", {}, t("Distance to "), make("b", {}, file)), words];
  }

  private buttons(): HTMLElement {
    const title = t("Compare the current state with the same file");
    const again = make("button", { type: "button", id: "compare-repeat", title }, t("Repeat"));
    again.onclick = () => void this.comparisons.repeat();
    const clear = make("button", { type: "button", id: "compare-clear" }, t("Clear"));
    clear.onclick = () => this.comparisons.clear();
    return make("div", { className: "row" }, again, clear);
  }

  private updateVisibility(): void {
    this.element.hidden = this.progressElement.hidden && this.resultElement.hidden;
  }
}
