import { make } from "../../dom/elements";
import { labelledRow, loadOnOpen, section } from "../../dom/rows";
import { ExportValues } from "../../gen/phrenic/v1/export_pb";
import type { Body } from "../../geometry/bodies";
import type { Exports } from "../../session/exports";
import type { Signal } from "../../state/signal";
import { exportProgress } from "./export_progress";
import { t } from "../../language/translate";

const valueNames: [ExportValues, string][] = [
  [ExportValues.UNSPECIFIED, "default"],
  [ExportValues.POSITIONS, "positions"],
  [ExportValues.DISPLACEMENTS, "displacements"],
];

/** Selects format, duration and bodies, and records the motion into a file. */
export function exportPanel(exports: Exports, bodies: Signal<Body[]>): HTMLElement {
  const start = make("button", { type: "button", id: "export", onclick: () => void exports.start() }, t("Export…"));
  const usual = make("option", { value: "" });
  const rows = [
    formatRow(exports),
    bodyRow(exports, bodies, usual),
    numberRow("export-seconds", t("Duration [s]"), "8", (value) => exports.choose({ seconds: value ?? 8 })),
    numberRow("export-fps", t("Frames per second"), t("default"), (value) =>
      exports.choose({ framesPerSecond: value }),
    ),
    valuesRow(exports),
  ];
  const [, bodyChoice, length, rate, values] = rows as [HTMLElement, ...HTMLElement[]];
  const hint = make("p", { className: "faint" });
  exports.choices.subscribe(() => {
    const format = exports.format;
    hint.textContent = t(format?.description ?? "");
    rate!.hidden = format?.instant ?? false;
    length!.hidden = (format?.instant ?? false) || (format?.page ?? false);
    bodyChoice!.hidden = format?.numbersOnly ?? false;
    usual.textContent = t(format?.page ? "what the scene shows" : "deformable bodies");
    values!.hidden = (format?.values.length ?? 0) < 2;
  });
  const panel = section(t("Export the motion"), false, ...rows, hint, start, exportProgress(exports, start, "export"));
  return loadOnOpen(panel, () => exports.loadFormats());
}

function formatRow(exports: Exports): HTMLElement {
  const list = make("select", { id: "export-format" });
  list.onchange = () => exports.choose({ format: list.value });
  exports.formats.subscribe((formats) => {
    list.replaceChildren(
      ...formats.map(({ name, instant }) =>
        make("option", { value: name }, instant ? t(".{0}, current state", name) : `.${name}`),
      ),
    );
    list.value = exports.choices.value.format;
    exports.choose({});
  });
  return labelledRow("export-format", t("Format"), list);
}

/** `usual` is the choice of the format's default. */
function bodyRow(exports: Exports, bodies: Signal<Body[]>, usual: HTMLElement): HTMLElement {
  const list = make("select", { id: "export-body" });
  const all = () => bodies.value.map(({ name }) => name);
  list.onchange = () => exports.choose({ bodies: list.value === "" ? [] : list.value === "*" ? all() : [list.value] });
  bodies.subscribe((present) => {
    const names = present.map(({ name }) => make("option", { value: name }, name));
    list.replaceChildren(usual, make("option", { value: "*" }, t("all bodies")), ...names);
    exports.choose({ bodies: [] });
  });
  return labelledRow("export-body", t("Bodies"), list);
}

function valuesRow(exports: Exports): HTMLElement {
  const list = make("select", { id: "export-values" });
  list.append(...valueNames.map(([value, label]) => make("option", { value: String(value) }, t(label))));
  list.onchange = () => exports.choose({ values: Number(list.value) });
  return labelledRow("export-values", t("Values"), list);
}

function numberRow(id: string, label: string, placeholder: string, choose: (value: number | undefined) => void) {
  const entry = make("input", { type: "number", step: "any", min: "0", id, placeholder });
  entry.onchange = () => choose(entry.value === "" ? undefined : entry.valueAsNumber);
  return labelledRow(id, label, entry);
}
