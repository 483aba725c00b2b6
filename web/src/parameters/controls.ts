import { type DescEnum, type DescField, type DescMessage, getOption, hasOption } from "@bufbuild/protobuf";
import { choice, group, quantity, type Quantity, toggle } from "../gen/phrenic/v1/options_pb";
import { type Parameters, ParametersSchema } from "../gen/phrenic/v1/parameters_pb";

/** A control for a number; all properties come from the options of the field. */
export interface NumberControl {
  kind: "number";
  field: string;
  /** Heading under which panels show the control; empty if the field has none. */
  group: string;
  label: string;
  help: string;
  unit: string;
  minimum: number;
  maximum: number;
  defaultValue: number;
  automatic: boolean;
  /** True if slider positions are logarithms, for ranges of three decades or more. */
  logarithmic: boolean;
  /** Smallest change, in slider positions. */
  step: number;
}

/** A control for a boolean. */
export interface SwitchControl {
  kind: "switch";
  field: string;
  group: string;
  label: string;
  help: string;
  defaultValue: boolean;
}

/** A control for an enum value. */
export interface ChoiceControl {
  kind: "choice";
  field: string;
  group: string;
  label: string;
  help: string;
  defaultValue: number;
  options: { value: number; label: string }[];
}

/** A control of a field. */
export type Control = NumberControl | SwitchControl | ChoiceControl;

/** Names of the live parameters in the message. */
export type ParameterName = Exclude<keyof Parameters, "$typeName" | "$unknown">;

/**
 * Returns a control for each field of `message` with a quantity, toggle or choice option, in the order of the schema.
 */
export function controlsOf(message: DescMessage): Control[] {
  return message.fields.flatMap((field) => controlOf(field) ?? []);
}

function controlOf(field: DescField): Control | undefined {
  if (hasOption(field, quantity)) return numberControl(field, getOption(field, quantity));
  if (hasOption(field, toggle)) return { kind: "switch", ...descriptionOf(field, getOption(field, toggle)) };
  if (field.fieldKind !== "enum" || !hasOption(field, choice)) return undefined;
  return { kind: "choice", ...descriptionOf(field, getOption(field, choice)), options: optionsOf(field.enum) };
}

function descriptionOf<T>(
  field: DescField,
  { label, help, defaultValue }: { label: string; help: string; defaultValue: T },
) {
  return {
    field: field.localName,
    group: getOption(field, group),
    label: label || field.localName,
    help,
    defaultValue,
  };
}

/** Returns all values except the unspecified one. */
function optionsOf(type: DescEnum): ChoiceControl["options"] {
  return type.values
    .filter(({ number }) => number !== 0)
    .map(({ number, localName }) => ({ value: number, label: choiceLabel(localName) }));
}

/** Formats "VELOCITY_VERLET" as "Velocity Verlet"; words without a vowel are abbreviations: "TR BDF2". */
export function choiceLabel(name: string): string {
  const spelled = (word: string) => (/[AEIOUY]/.test(word) ? word[0] + word.slice(1).toLowerCase() : word);
  return name.split("_").map(spelled).join(" ");
}

/** Returns the controls of the live parameters. */
export function parameterControls(): Control[] {
  return controlsOf(ParametersSchema);
}

function numberControl(field: DescField, q: Quantity): NumberControl {
  const logarithmic = q.minimum > 0 && q.maximum / q.minimum >= 1000;
  const span = logarithmic ? Math.log10(q.maximum / q.minimum) : q.maximum - q.minimum;
  return {
    kind: "number",
    ...descriptionOf(field, q),
    unit: q.unit === "1" ? "" : q.unit,
    minimum: q.minimum,
    maximum: q.maximum,
    automatic: q.automatic,
    logarithmic,
    step: !logarithmic && q.increment > 0 ? q.increment : span / 400,
  };
}
