import { ColorScale, topFor } from "../../appearance/color_scale";
import { make } from "../../dom/elements";
import { switchRow } from "../../dom/rows";
import type { Comparison, Comparisons, Work } from "../../session/comparisons";
import { Legend } from "../view/legend";
import { figuresTable } from "./distance_table";

/** Over the picture: how a comparison goes on, and what came of it, with the scale of its colours. */
export class ComparisonCard {
  readonly element = make("section", { id: "comparison", className: "card", ariaLabel: "Distance to a surface" });
  private readonly work = make("div", { className: "work" });
  private readonly found = make("div", { className: "found" });
  private readonly moved = make("p", { className: "faint", id: "comparison-moved" });
  private readonly legend = new Legend();
  private open = !matchMedia("(max-width: 760px)").matches;

  constructor(private readonly comparisons: Comparisons) {
    this.element.append(this.work, this.found);
    comparisons.work.subscribe((work) => this.showWork(work));
    comparisons.result.subscribe((result) => this.showResult(result));
  }

  /** Says where the session is meanwhile [s]. */
  show(time: number | undefined): void {
    const result = this.comparisons.result.value;
    const elsewhere = result !== undefined && time !== undefined && time !== result.time;
    const now = `at ${time?.toFixed(2)} s now`;
    const follows = `Colours follow the body, ${now}; “Again” measures there.`;
    const words = elsewhere ? (result.surface === undefined ? `The session is ${now}.` : follows) : "";
    if (this.moved.textContent !== words) this.moved.textContent = words;
  }

  private showWork(work: Work): void {
    this.work.hidden = work.kind === "idle";
    this.hide();
    if (work.kind === "running") this.showRunning(work.file, work.done);
    if (work.kind === "failed") this.showFailure(work.words);
  }

  private showRunning(file: string, done: number): void {
    const bar = make("progress", { max: 1, ariaLabel: "Progress of the comparison" });
    // A bar without a value says that nobody knows how long it takes.
    if (done > 0) bar.value = done;
    const stop = make("button", { type: "button", onclick: () => this.comparisons.stop() }, "Stop");
    const words = make("p", {}, "Comparing with ", make("b", {}, file), "…");
    words.setAttribute("role", "status");
    this.work.replaceChildren(words, make("div", { className: "row" }, bar, stop));
  }

  private showFailure(failure: string): void {
    const words = make("p", { className: "fault" }, failure);
    words.setAttribute("role", "alert");
    const dismiss = make("button", { type: "button", onclick: () => this.comparisons.stop() }, "Dismiss");
    this.work.replaceChildren(words, make("div", { className: "row" }, dismiss));
  }

  private showResult(result: Comparison | undefined): void {
    this.found.hidden = result === undefined;
    this.moved.textContent = "";
    this.hide();
    if (result === undefined) return;
    this.legend.show(new ColorScale(topFor(result.distances)));
    const figures = make("details", { open: this.open }, make("summary", {}, "Figures"), figuresTable(result.distance));
    figures.ontoggle = () => (this.open = figures.open);
    const rows = [this.legend.element, this.moved, ...this.drawnRow(result), this.buttons(), figures];
    this.found.replaceChildren(...this.heading(result), ...rows);
  }

  private drawnRow({ file, surface }: Comparison): HTMLElement[] {
    if (surface === undefined) return [];
    const { drawn } = this.comparisons;
    const { row, input } = switchRow("Show the surface", `${file}, yellow and seen through`, (on) => drawn.set(on));
    input.id = "compare-drawn";
    input.checked = drawn.value;
    return [row];
  }

  private heading({ file, body, time, tick }: Comparison): HTMLElement[] {
    const when = `${body} at ${time.toFixed(3)} s, tick ${tick}`;
    const words = make("p", { className: "faint", id: "comparison-when" }, when);
    return [make("h2", {}, "Distance to ", make("b", {}, file)), words];
  }

  private buttons(): HTMLElement {
    const title = "Compare with the same file as the session is now";
    const again = make("button", { type: "button", id: "compare-again", title }, "Again");
    again.onclick = () => void this.comparisons.again();
    const clear = make("button", { type: "button", id: "compare-clear" }, "Clear");
    clear.onclick = () => this.comparisons.clear();
    return make("div", { className: "row" }, again, clear);
  }

  private hide(): void {
    this.element.hidden = this.work.hidden && this.found.hidden;
  }
}
