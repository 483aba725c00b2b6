import { PhysiqueSchema } from "../gen/phrenic/v1/geometry_pb";
import { t } from "../language/translate";
import { type Control, controlsOf, type NumberControl } from "../parameters/controls";

/** The numbers of a body that are set, by their names in the message. Sex and age choose the others. */
export type BodyNumbers = Readonly<Record<string, number>>;

/** A body of the list that the page offers. */
export interface ReadyBody {
  title: string;
  numbers: BodyNumbers;
}

/** How the page shows a number, in addition to the schema's range, default and help. */
interface Shown {
  label: string;
  /** Smallest change, in the unit that is shown. */
  step?: number;
  /** Where the slider stands while the number is not set, in the unit that is shown. */
  neutral?: number;
  millimetres?: boolean;
}

/** Numbers under one heading. */
interface Group {
  title: string;
  numbers: Record<string, Shown>;
}

/** In the order of the page. */
export const groups: Group[] = [
  {
    title: "Person",
    numbers: {
      sex: { label: "Sex" },
      age: { label: "Age", step: 1 },
      height: { label: "Height", step: 0.01, neutral: 1.75 },
    },
  },
  {
    title: "Chest and ribs",
    numbers: {
      chestWidth: { label: "Width of the chest", step: 0.01, neutral: 1 },
      chestDepth: { label: "Depth of the chest", step: 0.01, neutral: 1 },
      ribSlopeDegrees: { label: "Slope of the ribs", step: 0.5, neutral: 0 },
      barrelChest: { label: "Barrel chest", step: 0.05 },
    },
  },
  {
    title: "Domes of the diaphragm",
    numbers: {
      rightDomeHeight: { label: "Height of the right dome", step: 1, neutral: 0, millimetres: true },
      leftDomeHeight: { label: "Height of the left dome", step: 1, neutral: 0, millimetres: true },
    },
  },
  {
    title: "Bend of the spine",
    numbers: {
      scoliosisDegrees: { label: "Scoliosis", step: 1, neutral: 0 },
      kyphosisDegrees: { label: "Kyphosis", step: 1, neutral: 0 },
    },
  },
];

/**
 * A control of a body's number. Its range, default and step are in the unit that is shown, `perUnit` of which is one of
 * SI.
 */
export interface BodyControl {
  control: Control;
  neutral: number | undefined;
  perUnit: number;
}

/** Returns the controls of a group. */
export function controlsOfGroup({ numbers }: Group): BodyControl[] {
  const controls = controlsOf(PhysiqueSchema);
  return Object.entries(numbers).map(([field, shown]) => {
    const found = controls.find((control) => control.field === field);
    if (found === undefined) throw new Error(`Physique has no number ${field}.`);
    const perUnit = shown.millimetres ? 1000 : 1;
    const control = found.kind === "number" ? inUnit(found, shown, perUnit) : { ...found, label: shown.label };
    return { control, neutral: shown.neutral, perUnit };
  });
}

function inUnit(control: NumberControl, { label, step }: Shown, perUnit: number): NumberControl {
  const { minimum, maximum, unit } = control;
  return {
    ...control,
    label,
    unit: perUnit === 1 ? unitOf(unit) : "mm",
    minimum: minimum * perUnit,
    maximum: maximum * perUnit,
    step: step ?? control.step,
  };
}

function unitOf(unit: string): string {
  return unit === "years" ? t("years") : unit.replace("deg", "°");
}

/**
 * Reads a list of bodies: "Title: name=value name=value", a line each; "#" begins a comment. Throws Error for an
 * unknown name.
 */
export function readBodies(text: string): ReadyBody[] {
  const lines = text.split("\n").filter((line) => line.trim() !== "" && !line.startsWith("#"));
  return lines.map((line) => {
    const [title, words] = line.split(/:(.*)/, 2);
    const pairs = words.trim().split(/\s+/).filter(Boolean);
    return { title, numbers: Object.fromEntries(pairs.map((pair) => readPair(pair))) };
  });
}

function readPair(pair: string): [string, number] {
  const [name, value] = pair.split("=", 2);
  const field = PhysiqueSchema.fields.find((each) => each.name === name);
  if (field === undefined) throw new Error(`A body has no number ${name}.`);
  if (field.fieldKind !== "enum") return [field.localName, Number(value)];
  const chosen = field.enum.values.find(({ localName }) => localName.toLowerCase() === value);
  if (chosen === undefined) throw new Error(`There is no ${name} ${value}.`);
  return [field.localName, chosen.number];
}

/** True if both have the same numbers. */
export function sameNumbers(a: BodyNumbers, b: BodyNumbers): boolean {
  const names = Object.keys(a);
  return names.length === Object.keys(b).length && names.every((name) => a[name] === b[name]);
}
