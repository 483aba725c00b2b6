import { make } from "../dom/elements";
import { section } from "../dom/rows";
import type { OfflineMotion } from "../gen/phrenic/v1/offline_pb";
import type { Parameters } from "../gen/phrenic/v1/parameters_pb";
import { type Control, parameterControls } from "../parameters/controls";
import { differences } from "../parameters/differences";
import { formatNumber } from "../parameters/numbers";
import { activePreset, presetLabel } from "../parameters/presets";
import { decimal, t } from "../language/translate";

/** Returns a section with the scene and the preset, how the parameters differ from the scene's, and all parameters. */
export function factsSection(motion: OfflineMotion): HTMLElement {
  const active = activePreset(motion.presets, motion.parameters);
  const changed = differences(motion.sceneParameters, motion.parameters);
  const rows: [name: string, words: string][] = [
    [t("Scene"), `${t(motion.sceneTitle) || motion.scene} (${motion.scene})`],
  ];
  if (active !== undefined) rows.push([t("Breath"), `${presetLabel(active)}. ${t(active.description)}`]);
  rows.push([t("Parameters"), changed === "" ? t("Those of the scene.") : `${changed}.`]);
  const list = rows.flatMap(([name, words]) => [make("dt", {}, name), make("dd", {}, words)]);
  const all = make("details", {}, make("summary", {}, t("All parameters")), parameterTable(motion.parameters));
  return section(t("What is shown"), true, make("div", { className: "report" }, make("dl", {}, ...list), all));
}

function parameterTable(parameters: Parameters | undefined): HTMLElement {
  const values = (parameters ?? {}) as unknown as Record<string, number | boolean>;
  const rows = parameterControls().map((control) => {
    const cell = make("td", {}, valueText(control, values[control.field]));
    return make("tr", {}, make("th", { scope: "row" }, control.label), cell);
  });
  return make("table", { className: "probes" }, make("tbody", {}, ...rows));
}

function valueText(control: Control, value: number | boolean | undefined): string {
  if (value === undefined) return "";
  if (typeof value === "boolean") return value ? "on" : "off";
  if (control.kind === "choice") return control.options.find((each) => each.value === value)?.label ?? String(value);
  const unit = control.kind === "number" && control.unit !== "" ? ` ${control.unit}` : "";
  return decimal(formatNumber(value)) + unit;
}
