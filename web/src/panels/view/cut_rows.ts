import { make } from "../../dom/elements";
import { labelledRow, switchRow } from "../../dom/rows";
import type { Signal } from "../../state/signal";
import type { Cut, CutKind } from "../../viewer/clipping";
import { t } from "../../language/translate";

const kinds: [CutKind, string][] = [
  ["none", "No cut"],
  ["sagittal", "Sagittal"],
  ["coronal", "Coronal"],
  ["transverse", "Transverse"],
];

/** Rows for a clipping plane: orientation, position and side. `cutAt` returns its position [m]. */
export function cutRows(cut: Signal<Cut>, cutAt: (cut: Cut) => number): HTMLElement[] {
  const list = make("select", { id: "cut", title: t("Clip one side of a plane") });
  list.append(...kinds.map(([value, label]) => make("option", { value }, t(label))));
  list.onchange = () => cut.set({ ...cut.value, kind: list.value as CutKind });
  const slider = make("input", { type: "range", id: "cut-position", min: "0", max: "1", step: "0.005" });
  slider.oninput = () => cut.set({ ...cut.value, fraction: slider.valueAsNumber });
  const output = make("output", { className: "unit" });
  const flip = switchRow(t("Keep the other side"), "", (flipped) => cut.set({ ...cut.value, flipped }));
  flip.input.id = "cut-flip";
  const label = make("label", { htmlFor: "cut-position" }, t("Position of the cut"));
  const position = make("div", { className: "number-row plain" }, label, output, slider);
  cut.subscribe((value) => {
    position.hidden = flip.row.hidden = value.kind === "none";
    list.value = value.kind;
    flip.input.checked = value.flipped;
    slider.value = String(value.fraction);
    slider.style.setProperty("--filled", `${100 * value.fraction}%`);
    output.textContent = `${Math.round(1000 * cutAt(value))} mm`;
    slider.setAttribute("aria-valuetext", output.textContent);
  });
  const row = labelledRow("cut", t("Cut"), list);
  return [row, position, flip.row];
}
