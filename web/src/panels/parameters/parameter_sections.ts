import { button, make } from "../../dom/elements";
import { icon } from "../../dom/icons";
import { section, switchRow } from "../../dom/rows";
import { ParametersSchema } from "../../gen/phrenic/v1/parameters_pb";
import type { CompileReport } from "../../gen/phrenic/v1/report_pb";
import type { Preset } from "../../gen/phrenic/v1/scene_pb";
import { type Control, parameterControls, type ParameterName, type SwitchControl } from "../../parameters/controls";
import type { SessionController } from "../../session/session_controller";
import { Signal } from "../../state/signal";
import { ChoiceRow } from "./choice_row";
import { NumberRow } from "./number_row";
import { PresetRow } from "./preset_row";
import { pullRow } from "./pull_row";
import { t } from "../../language/translate";

/**
 * Sections with the live parameters, one per group and one row per field of the schema; the first has the presets too,
 * the last is the solver's. Parameters without effect in this scene are hidden, and groups that have no others. Rows
 * follow the changes of other viewers.
 */
export function parameterSections(
  controller: SessionController,
  report?: Signal<CompileReport | undefined>,
  presets = new Signal<Preset[]>([]),
): HTMLElement[] {
  const rows = parameterControls().map((control) => parameterRow(control, controller));
  controller.session.subscribe((session) => {
    if (session?.parameters === undefined) return;
    for (const { name, show } of rows) if (!controller.pending(name)) show(session.parameters[name]);
  });
  const sections = groupSections(rows);
  report?.subscribe((value) => {
    const idle = new Set(value?.idleParameters.map((name) => localNameOf(name)));
    for (const { name, element } of rows) element.hidden = idle.has(name);
    for (const { element, members } of sections.slice(1)) element.hidden = members.every(({ name }) => idle.has(name));
  });
  const ways = new PresetRow(controller, presets).element;
  const [first] = sections;
  first.element.querySelector("summary")?.after(ways, changesRow(controller), pullRow(controller));
  return sections.map(({ element }) => element);
}

/** Returns a section for each group of rows, in the order of the schema. */
function groupSections(rows: Row[]): { element: HTMLElement; members: Row[] }[] {
  const groups = new Map<string, Row[]>();
  for (const row of rows) groups.set(row.group, [...(groups.get(row.group) ?? []), row]);
  return [...groups].map(([title, members]) => ({
    element: section(t(title), true, ...members.map(({ element }) => element)),
    members,
  }));
}

/** Buttons to undo, redo and reset all parameters. */
function changesRow(controller: SessionController): HTMLElement {
  const undo = button(t("Undo"), () => controller.undo(), icon("undo"), t("Undo"));
  const redo = button(t("Redo"), () => controller.redo(), icon("redo"), t("Redo"));
  const all = button(t("Reset all parameters"), () => void controller.resetAll(), t("Reset all"));
  [undo.id, redo.id, all.id] = ["undo", "redo", "reset-all"];
  controller.changes.state.subscribe((state) => {
    undo.disabled = !state.undo;
    redo.disabled = !state.redo;
  });
  return make("div", { className: "changes" }, undo, redo, all);
}

function localNameOf(name: string): string | undefined {
  return ParametersSchema.fields.find((field) => field.name === name)?.localName;
}

interface Row {
  name: ParameterName;
  group: string;
  element: HTMLElement;
  show(value: number | boolean | undefined): void;
}

function parameterRow(control: Control, controller: SessionController): Row {
  const name = control.field as ParameterName;
  if (control.kind === "switch") return parameterSwitch(control, name, controller);
  const events = {
    set: (value: number) => controller.set(name, value),
    reset: () => void reset(controller, name),
  };
  const row = control.kind === "choice" ? new ChoiceRow(control, events) : new NumberRow(control, events);
  const { group } = control;
  return { name, group, element: row.element, show: (value) => typeof value === "number" && row.show(value) };
}

function parameterSwitch(control: SwitchControl, name: ParameterName, controller: SessionController): Row {
  const { row, input } = switchRow(t(control.label), t(control.help), (on) => controller.set(name, on));
  input.id = `parameter-${name}`;
  return {
    name,
    group: control.group,
    element: row,
    show: (value) => (input.checked = value === undefined ? input.checked : value === true),
  };
}

/** Sets the parameter to the initial value of the scene. */
async function reset(controller: SessionController, name: ParameterName): Promise<void> {
  const value = (await controller.startValues())?.[name];
  if (typeof value === "number" || typeof value === "boolean") controller.set(name, value);
}
