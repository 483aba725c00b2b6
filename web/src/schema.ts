import { type DescMessage, getOption, hasOption } from "@bufbuild/protobuf";
import { quantity, type Quantity, toggle } from "./gen/phrenic/v1/options_pb";
import { type Parameters, ParametersSchema } from "./gen/phrenic/v1/parameters_pb";

/** A number of a message as a person sets it; everything in it comes from the field's options. */
export interface NumberControl {
  kind: "number";
  field: string;
  label: string;
  help: string;
  unit: string;
  minimum: number;
  maximum: number;
  defaultValue: number;
  automatic: boolean;
  /** Slider positions are the value itself, or its logarithm where the range spans three decades or more. */
  logarithmic: boolean;
  /** The smallest change offered, in slider positions. */
  step: number;
}

/** A switch of a message as a person sets it. */
export interface SwitchControl {
  kind: "switch";
  field: string;
  label: string;
  help: string;
  defaultValue: boolean;
}

export type Control = NumberControl | SwitchControl;

/** Names of the live parameters as they stand in the message. */
export type ParameterName = Exclude<keyof Parameters, "$typeName" | "$unknown">;

/** One control for each field of `message` that carries a quantity or a toggle, in the schema's order. */
export function controlsOf(message: DescMessage): Control[] {
  return message.fields.flatMap((field): Control[] => {
    if (hasOption(field, quantity)) return [numberControl(field.localName, getOption(field, quantity))];
    if (!hasOption(field, toggle)) return [];
    const { label, help, defaultValue } = getOption(field, toggle);
    return [{ kind: "switch", field: field.localName, label: label || field.localName, help, defaultValue }];
  });
}

export function parameterControls(): Control[] {
  return controlsOf(ParametersSchema);
}

function numberControl(field: string, q: Quantity): NumberControl {
  const logarithmic = q.minimum > 0 && q.maximum / q.minimum >= 1000;
  const span = logarithmic ? Math.log10(q.maximum / q.minimum) : q.maximum - q.minimum;
  return {
    kind: "number",
    field,
    label: q.label || field,
    help: q.help,
    unit: q.unit === "1" ? "" : q.unit,
    minimum: q.minimum,
    maximum: q.maximum,
    defaultValue: q.defaultValue,
    automatic: q.automatic,
    logarithmic,
    step: !logarithmic && q.increment > 0 ? q.increment : span / 400,
  };
}

/** Where the slider stands for `value`. */
export function positionOf(control: NumberControl, value: number): number {
  return control.logarithmic ? Math.log10(value) : value;
}

/** The value for a slider's position, rounded to what the slider can tell apart, inside the range. */
export function valueAt(control: NumberControl, position: number): number {
  const raw = control.logarithmic ? 10 ** position : position;
  const value = control.logarithmic ? Number(raw.toPrecision(3)) : Number(raw.toFixed(decimalsOf(control.step)));
  return Math.min(control.maximum, Math.max(control.minimum, value));
}

function decimalsOf(step: number): number {
  return Math.max(0, Math.min(12, Math.ceil(-Math.log10(step) - 1e-9) + 1));
}

/** Why `value` may not be sent, or nothing. */
export function faultOf(control: NumberControl, value: number): string | undefined {
  if (Number.isFinite(value) && value >= control.minimum && value <= control.maximum) return undefined;
  return `${control.label} goes from ${formatNumber(control.minimum)} to ${formatNumber(control.maximum)}${
    control.unit ? " " + control.unit : ""
  }.`;
}

/** At most four significant digits, without trailing zeros. */
export function formatNumber(value: number): string {
  return String(Number(value.toPrecision(4)));
}
