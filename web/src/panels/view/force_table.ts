import { make } from "../../dom/elements";
import { forceKindLabel, type VertexForce } from "../../session/force_queries";
import type { Signal } from "../../state/signal";
import { t } from "../../language/translate";

/** A table of the forces on a vertex by kind, with the net force last; hidden if they are unknown. */
export function forceTable(forces: Signal<VertexForce[]>): HTMLElement {
  const unit = make("th", { scope: "col" });
  const heads = ["Left", "Back", "Up"].map((text) => make("th", { scope: "col" }, t(text)));
  const rows = make("tbody");
  const head = make("thead", {}, make("tr", {}, unit, ...heads));
  const table = make("table", { className: "figures", id: "forces", ariaLabel: t("Forces on the vertex") }, head, rows);
  forces.subscribe((all) => {
    table.hidden = all.length === 0;
    const { name, factor } = forceUnit(all);
    unit.textContent = name;
    rows.replaceChildren(...all.map((each) => row(each, factor)));
  });
  return table;
}

/** Returns newtons if a force is 1 N or more, otherwise millinewtons. */
export function forceUnit(all: VertexForce[]): { name: string; factor: number } {
  const largest = Math.max(0, ...all.map(({ force }) => Math.hypot(...force)));
  return largest >= 1 ? { name: "N", factor: 1 } : { name: "mN", factor: 1000 };
}

function row({ kind, force }: VertexForce, factor: number): HTMLElement {
  const cells = force.map((each) => make("td", {}, formatForce(factor * each)));
  return make("tr", {}, make("th", { scope: "row" }, forceKindLabel(kind)), ...cells);
}

/** Formats two decimals, without a minus sign for zero. */
function formatForce(value: number): string {
  return value
    .toFixed(2)
    .replace(/^-(0\.00)$/, "$1")
    .replace("-", "−");
}
