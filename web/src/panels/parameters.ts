import type { Controller } from "../controller";
import { type Control, parameterControls, type ParameterName } from "../schema";
import { section, switchRow } from "./dom";
import { NumberRow } from "./number_row";

/** The live parameters, one row for each field of the schema. Another viewer's changes move the rows. */
export function parametersPanel(controller: Controller): HTMLElement {
  const rows = parameterControls().map((control) => parameterRow(control, controller));
  controller.session.subscribe((session) => {
    if (session?.parameters === undefined) return;
    for (const { name, show } of rows) if (!controller.pending(name)) show(session.parameters[name]);
  });
  return section("Breathing", true, ...rows.map((row) => row.element));
}

interface Row {
  name: ParameterName;
  element: HTMLElement;
  show(value: number | boolean | undefined): void;
}

function parameterRow(control: Control, controller: Controller): Row {
  const name = control.field as ParameterName;
  if (control.kind === "switch") {
    const { row, input } = switchRow(control.label, control.help, (on) => controller.set(name, on));
    input.id = `parameter-${name}`;
    return {
      name,
      element: row,
      show: (value) => (input.checked = value === undefined ? input.checked : value === true),
    };
  }
  const row = new NumberRow(control, {
    set: (value) => controller.set(name, value),
    reset: () => void reset(controller, name),
  });
  return { name, element: row.element, show: (value) => typeof value === "number" && row.show(value) };
}

/** Back to what a session of this scene starts with. */
async function reset(controller: Controller, name: ParameterName): Promise<void> {
  const value = (await controller.startValues())?.[name];
  if (typeof value === "number" || typeof value === "boolean") controller.set(name, value);
}
