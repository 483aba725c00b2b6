import type { Coloring } from "../../appearance/coloring";
import { fieldInfo } from "../../appearance/fields";
import { make } from "../../dom/elements";
import { Legend } from "./legend";
import { t } from "../../language/translate";

/** A card with the colour scale of the selected field. */
export function coloringCard(coloring: Coloring): HTMLElement {
  const legend = new Legend();
  const title = make("h2");
  const top = make("input", {
    type: "number",
    id: "coloring-top",
    min: "0",
    step: "any",
    ariaLabel: t("End of the scale"),
  });
  top.onchange = () => coloring.setTop(top.valueAsNumber);
  const fit = make(
    "button",
    { type: "button", id: "coloring-fit", title: t("Fit the scale to the current values") },
    t("Fit"),
  );
  fit.onclick = () => coloring.fit();
  const row = make(
    "div",
    { className: "row" },
    make("label", { htmlFor: "coloring-top" }, t("End of scale")),
    top,
    fit,
  );
  const note = make("p", { className: "faint", id: "coloring-note" });
  note.setAttribute("role", "status");
  coloring.message.subscribe((words) => (note.textContent = t(words)));
  const card = make("section", { id: "coloring", className: "card", hidden: true }, title, legend.element, row, note);
  card.ariaLabel = t("Colours of the surface");
  coloring.scale.subscribe((scale) => {
    card.hidden = scale === undefined;
    const info = fieldInfo(coloring.field.value);
    if (scale === undefined || info === undefined) return;
    title.textContent = t(info.label);
    title.title = t(info.help);
    legend.show(scale);
    top.value = String(scale.top);
  });
  return card;
}
