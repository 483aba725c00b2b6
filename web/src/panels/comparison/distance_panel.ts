import { make } from "../../dom/elements";
import { labelledRow, section } from "../../dom/rows";
import type { Body } from "../../geometry/bodies";
import type { Comparisons } from "../../session/comparisons";
import type { Signal } from "../../state/signal";
import { t } from "../../language/translate";

const units: [label: string, millimetres: number][] = [
  ["millimetres", 1],
  ["centimetres", 10],
  ["metres", 1000],
];

/** Selects a file, its unit, and the body that is compared with it. Files may also be dropped on the page. */
export function distancePanel(
  comparisons: Comparisons,
  bodies: Signal<Body[]>,
  endings: Signal<string[]>,
): HTMLElement {
  const file = make("input", { type: "file", id: "compare-file", hidden: true });
  file.ariaLabel = t("File to compare with");
  file.onchange = () => {
    const [chosen] = file.files ?? [];
    // Allows to select the same file again after it changed.
    if (chosen !== undefined) void comparisons.compare(chosen).finally(() => (file.value = ""));
  };
  const open = make(
    "button",
    { type: "button", id: "compare", onclick: () => file.click() },
    t("Compare with a file…"),
  );
  const hint = make("p", { className: "faint" });
  endings.subscribe((all) => {
    file.accept = all.join(",");
    hint.textContent = t("A surface ({0}) or motion (.msh); files can also be dropped on the page.", all.join(", "));
  });
  const rows = [bodyRow(comparisons, bodies), unitRow(comparisons), timeRow(comparisons)];
  return section(t("Distance to a surface"), true, ...rows, open, file, hint);
}

function bodyRow(comparisons: Comparisons, bodies: Signal<Body[]>): HTMLElement {
  const list = make("select", { id: "compare-body" });
  list.onchange = () => comparisons.choose({ body: list.value });
  bodies.subscribe((all) => {
    const solid = all.filter(({ triangles }) => triangles.length > 0);
    list.replaceChildren(...solid.map(({ name }) => make("option", { value: name }, name)));
  });
  comparisons.choices.subscribe(({ body }) => (list.value = body));
  return labelledRow("compare-body", t("Body"), list);
}

function unitRow(comparisons: Comparisons): HTMLElement {
  const list = make("select", { id: "compare-unit" });
  list.append(...units.map(([label, millimetres]) => make("option", { value: String(millimetres) }, label)));
  list.onchange = () => comparisons.choose({ unitMm: Number(list.value) });
  return labelledRow("compare-unit", t("Unit of the file"), list);
}

function timeRow(comparisons: Comparisons): HTMLElement {
  const help = t("For a motion file: time of the compared state in seconds; empty for the session's time");
  const entry = make("input", {
    type: "number",
    step: "any",
    id: "compare-time",
    placeholder: t("current"),
    title: help,
  });
  entry.onchange = () => comparisons.choose({ time: entry.value === "" ? undefined : entry.valueAsNumber });
  return labelledRow("compare-time", t("Time in the motion [s]"), entry);
}
