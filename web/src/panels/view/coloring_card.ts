import type { Coloring } from "../../appearance/coloring";
import { fieldInfo } from "../../appearance/fields";
import { make } from "../../dom/elements";
import { Legend } from "./legend";

/** A card with the colour scale of the selected field. */
export function coloringCard(coloring: Coloring): HTMLElement {
  const legend = new Legend();
  const title = make("h2");
  const top = make("input", {
    type: "number",
    id: "coloring-top",
    min: "0",
    step: "any",
    ariaLabel: "End of the scale",
  });
  top.onchange = () => coloring.setTop(top.valueAsNumber);
  const fit = make(
    "button",
    { type: "button", id: "coloring-fit", title: "Fit the scale to the current values" },
    "Fit",
  );
  fit.onclick = () => coloring.fit();
  const row = make("div", { className: "row" }, make("label", { htmlFor: "coloring-top" }, "End of scale"), top, fit);
  const note = make("p", { className: "faint", id: "coloring-note" });
  note.setAttribute("role", "status");
  coloring.message.subscribe((words) => (note.textContent = words));
  const card = make("section", { id: "coloring", className: "card", hidden: true }, title, legend.element, row, note);
  card.ariaLabel = "Colours of the surface";
  coloring.scale.subscribe((scale) => {
    card.hidden = scale === undefined;
    const info = fieldInfo(coloring.field.value);
    if (scale === undefined || info === undefined) return;
    title.textContent = info.label;
    title.title = info.help;
    legend.show(scale);
    top.value = String(scale.top);
  });
  return card;
}
