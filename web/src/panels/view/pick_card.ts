import { type TrackedVertices, vertexLabel, type VertexState } from "../../appearance/tracked_vertices";
import { make } from "../../dom/elements";
import type { FrameArrays } from "../../geometry/bodies";
import type { VertexRef } from "../../geometry/vertices";
import { curveColor } from "../../graphs/colors";
import type { VertexForce } from "../../session/force_queries";
import type { Signal } from "../../state/signal";
import { forceTable } from "./force_table";
import { fixed, t } from "../../language/translate";

/** A card with position, displacement and forces of the picked vertex, and the list of tracked vertices. */
export class PickCard {
  readonly element = make("section", { id: "picked", className: "card", hidden: true, ariaLabel: t("Picked vertex") });
  private readonly title = make("h2");
  private readonly rows = make("tbody");
  private readonly trackedList = make("div", { className: "tracked" });
  private readonly trackButton = make("button", { type: "button", id: "track" }, t("Track"));

  constructor(
    private readonly trackedVertices: TrackedVertices,
    forces: Signal<VertexForce[]>,
  ) {
    const close = make("button", { type: "button", onclick: () => trackedVertices.picked.set(undefined) }, t("Close"));
    this.trackButton.title = t("Mark the vertex and plot its displacement");
    this.trackButton.onclick = () => {
      if (trackedVertices.picked.value !== undefined) trackedVertices.track(trackedVertices.picked.value);
    };
    const heads = ["mm", "Left", "Back", "Up"].map((text) => make("th", { scope: "col" }, t(text)));
    const table = make("table", { className: "figures" }, make("thead", {}, make("tr", {}, ...heads)), this.rows);
    const buttons = make("div", { className: "row" }, this.trackButton, close);
    const own = make("div", { className: "result" }, this.title, table, forceTable(forces), buttons);
    this.element.append(own, this.trackedList);
    trackedVertices.picked.subscribe((ref) => {
      own.hidden = ref === undefined;
      if (ref !== undefined)
        this.title.replaceChildren(t("Vertex "), make("b", {}, String(ref.vertex)), t(" of {0}", ref.body));
      this.updateVisibility();
    });
    trackedVertices.tracked.subscribe((refs) => {
      this.trackedList.replaceChildren(...refs.map((ref, i) => this.trackedRow(ref, i)));
      this.updateVisibility();
    });
  }

  /** Shows the state of the picked vertex in a frame. */
  show(arrays: FrameArrays | undefined): void {
    const ref = this.trackedVertices.picked.value;
    if (ref === undefined || arrays === undefined) return;
    const state = this.trackedVertices.stateOf(ref, arrays);
    if (state === undefined) return;
    const text = rowsOf(state);
    while (this.rows.rows.length < text.length) this.rows.append(row());
    text.forEach((cells, i) => cells.forEach((cell, k) => write(this.rows.rows[i].cells[k], cell)));
  }

  private trackedRow(ref: VertexRef, order: number): HTMLElement {
    const swatch = make("span", { className: "swatch" });
    swatch.style.backgroundColor = curveColor(order);
    const name = vertexLabel(ref);
    const leave = make(
      "button",
      { type: "button", className: "small", ariaLabel: t("Stop tracking {0}", name) },
      t("Stop"),
    );
    leave.onclick = () => this.trackedVertices.untrack(ref);
    return make("div", { className: "key" }, swatch, make("span", {}, name), leave);
  }

  private updateVisibility(): void {
    const { picked, tracked } = this.trackedVertices;
    this.element.hidden = picked.value === undefined && tracked.value.length === 0;
    const known = picked.value !== undefined && this.trackedVertices.indexOf(picked.value) >= 0;
    this.trackButton.disabled = known;
  }
}

function rowsOf({ position, displacement }: VertexState): string[][] {
  const words = (metres: number[]) => metres.map((each) => fixed(1000 * each, 1).replace("-", "−"));
  return [
    [t("Position"), ...words(position)],
    [t("Displacement"), ...words(displacement)],
  ];
}

function row(): HTMLTableRowElement {
  return make("tr", {}, make("th", { scope: "row" }), make("td"), make("td"), make("td"));
}

function write(cell: HTMLElement, text: string): void {
  if (cell.textContent !== text) cell.textContent = text;
}
