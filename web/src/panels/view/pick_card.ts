import { type Following, nameOf, type Standing } from "../../appearance/tracked_vertices";
import { make } from "../../dom/elements";
import type { FrameArrays } from "../../geometry/bodies";
import type { VertexRef } from "../../geometry/vertices";
import { curveColor } from "../../graphs/colors";
import type { ForceOnVertex } from "../../session/force_queries";
import type { Signal } from "../../state/signal";
import { forceTable } from "./force_table";

/** Over the picture: the vertex that was picked, where it is, and those that are followed. */
export class PickCard {
  readonly element = make("section", { id: "picked", className: "card", hidden: true, ariaLabel: "Picked vertex" });
  private readonly title = make("h2");
  private readonly rows = make("tbody");
  private readonly followed = make("div", { className: "followed" });
  private readonly follow = make("button", { type: "button", id: "follow" }, "Follow it");

  constructor(
    private readonly following: Following,
    forces: Signal<ForceOnVertex[]>,
  ) {
    const close = make("button", { type: "button", onclick: () => following.picked.set(undefined) }, "Close");
    this.follow.title = "Mark it and draw a graph of it";
    this.follow.onclick = () => {
      if (following.picked.value !== undefined) following.follow(following.picked.value);
    };
    const heads = ["mm", "Left", "Back", "Up"].map((text) => make("th", { scope: "col" }, text));
    const table = make("table", { className: "figures" }, make("thead", {}, make("tr", {}, ...heads)), this.rows);
    const buttons = make("div", { className: "row" }, this.follow, close);
    const own = make("div", { className: "found" }, this.title, table, forceTable(forces), buttons);
    this.element.append(own, this.followed);
    following.picked.subscribe((ref) => {
      own.hidden = ref === undefined;
      if (ref !== undefined)
        this.title.replaceChildren("Vertex ", make("b", {}, String(ref.vertex)), ` of ${ref.body}`);
      this.hide();
    });
    following.all.subscribe((refs) => {
      this.followed.replaceChildren(...refs.map((ref, i) => this.followedRow(ref, i)));
      this.hide();
    });
  }

  show(arrays: FrameArrays | undefined): void {
    const ref = this.following.picked.value;
    if (ref === undefined || arrays === undefined) return;
    const standing = this.following.standing(ref, arrays);
    if (standing === undefined) return;
    const text = rowsOf(standing);
    while (this.rows.rows.length < text.length) this.rows.append(row());
    text.forEach((cells, i) => cells.forEach((cell, k) => write(this.rows.rows[i].cells[k], cell)));
  }

  private followedRow(ref: VertexRef, order: number): HTMLElement {
    const swatch = make("span", { className: "swatch" });
    swatch.style.backgroundColor = curveColor(order);
    const name = nameOf(ref);
    const leave = make("button", { type: "button", className: "small", ariaLabel: `Leave ${name}` }, "Leave");
    leave.onclick = () => this.following.leave(ref);
    return make("div", { className: "key" }, swatch, make("span", {}, name), leave);
  }

  private hide(): void {
    const { picked, all } = this.following;
    this.element.hidden = picked.value === undefined && all.value.length === 0;
    const known = picked.value !== undefined && this.following.order(picked.value) >= 0;
    this.follow.disabled = known;
  }
}

function rowsOf({ place, way }: Standing): string[][] {
  const words = (metres: number[]) => metres.map((each) => (1000 * each).toFixed(1).replace("-", "−"));
  return [
    ["Place", ...words(place)],
    ["From rest", ...words(way)],
  ];
}

function row(): HTMLTableRowElement {
  return make("tr", {}, make("th", { scope: "row" }), make("td"), make("td"), make("td"));
}

function write(cell: HTMLElement, text: string): void {
  if (cell.textContent !== text) cell.textContent = text;
}
