import type { Frame } from "../gen/phrenic/v1/frames_pb";
import { cmH2O, displayUnit } from "./units";
import { t } from "../language/translate";

/** A curve of a graph: the key of its values, and the factor from SI to the unit of the graph. */
export interface Curve {
  key: string;
  name: string;
  factor: number;
  /** Place of its colour in the palette; not set: its place among the curves. */
  order?: number;
  /** True for a dashed line. */
  dashed?: boolean;
}

/** A graph that a scene offers: curves over time, or one curve over another. */
export interface GraphSpec {
  id: string;
  title: string;
  /** Explanation, if the title is not sufficient. */
  help?: string;
  unit: string;
  curves: Curve[];
  /** For a loop: the quantity on the horizontal axis. */
  abscissa?: Curve & { unit: string };
}

/** Returns the values of a frame by the keys of the curves, in SI units. */
export function valuesOf(frame: Frame): [key: string, value: number][] {
  return [
    ...frame.measures.map(({ name, value }): [string, number] => [measureKey(name), value]),
    ...frame.probes.map(({ name, dz }): [string, number] => [probeKey(name), dz]),
    ...ribCageVolume(frame).map((value): [string, number] => [ribCageKey, value]),
    ["breath", frame.breath],
  ];
}

/** Returns the key of a measure in a time series. */
export const measureKey = (name: string) => `measure ${name}`;
const probeKey = (name: string) => `probe ${name}`;

/** Returns the graphs of the measures and probes of a frame, the most informative first. */
export function graphsOf(frame: Frame): GraphSpec[] {
  const [volume, ...volumes] = byUnit(frame, "m^3", "Volume", false);
  return [
    ...(volume === undefined ? [] : [volume]),
    ...byUnit(frame, "m^3/s", "Flow", true),
    ...domes(frame),
    ...byUnit(frame, "Pa", "Pressure", true),
    ...loop(frame),
    ...flowVolumeLoop(frame),
    ...konnoMead(frame),
    ...probes(frame),
    ...volumes,
    ...byUnit(frame, "m", "Height", true),
    ...byUnit(frame, "J", "Energy", true),
    ...others(frame),
    { id: "breath", title: "Breath wave", unit: "", curves: [{ key: "breath", name: "breath", factor: 1 }] },
  ];
}

const known = ["m^3", "m^3/s", "Pa", "m", "J"];

function others(frame: Frame): GraphSpec[] {
  const units = new Set(frame.measures.map(({ unit }) => unit).filter((unit) => !known.includes(unit)));
  return [...units].flatMap((unit) => byUnit(frame, unit, unit, true));
}

/** Returns the measures of one unit in one graph, or in one graph each. */
function byUnit({ measures }: Frame, unit: string, title: string, together: boolean): GraphSpec[] {
  const [familiar, factor] = displayUnit(unit);
  const curves = measures
    .filter((each) => each.unit === unit && !isDomeHeight(each))
    .map(({ name }) => curve(measureKey(name), name, factor));
  if (curves.length === 0) return [];
  if (together && curves.length > 1)
    return [{ id: title.toLowerCase(), title: t(`${title}s`.replace(/ys$/, "ies")), unit: familiar, curves }];
  return curves.map((each) => ({ id: each.key, title: capital(t(each.name)), unit: familiar, curves: [each] }));
}

/** Pressure-volume loop: the enclosed area is work. */
function loop({ measures }: Frame): GraphSpec[] {
  const pressures = measures.filter(({ unit }) => unit === "Pa");
  const pressure = pressures.find(({ name }) => name.includes("pleural")) ?? pressures[0];
  const volume = measures.find(({ unit }) => unit === "m^3");
  if (pressure === undefined || volume === undefined) return [];
  const [unit, factor] = displayUnit("m^3");
  const abscissa = { ...curve(measureKey(pressure.name), pressure.name, 1), unit: "Pa" };
  const curves = [curve(measureKey(volume.name), volume.name, factor)];
  return [{ id: "loop", title: "P–V loop", unit, curves, abscissa }];
}

/** Flow over volume, as a spirometer draws it: a narrow airway dents the limb of expiration. */
function flowVolumeLoop({ measures }: Frame): GraphSpec[] {
  const volume = measures.find(({ name }) => name === "lung volume");
  const flow = measures.find(({ unit }) => unit === "m^3/s");
  if (volume === undefined || flow === undefined) return [];
  const [unit, factor] = displayUnit("m^3/s");
  const [litre, perLitre] = displayUnit("m^3");
  const abscissa = { ...curve(measureKey(volume.name), volume.name, perLitre), unit: litre };
  const curves = [curve(measureKey(flow.name), flow.name, factor)];
  return [{ id: "flow-volume", title: "Flow–volume loop", unit, curves, abscissa }];
}

/**
 * The Konno-Mead diagram: what the rib cage displaces over what the abdomen displaces. A quiet breath is a narrow loop
 * upwards to the right; a loop to the left is paradoxical motion.
 */
function konnoMead(frame: Frame): GraphSpec[] {
  if (ribCageVolume(frame).length === 0) return [];
  const [unit, factor] = displayUnit("m^3");
  const abscissa = { ...curve(measureKey(abdomen), abdomen, factor), unit };
  return [
    {
      id: "konno-mead",
      title: "Konno–Mead diagram",
      unit,
      curves: [curve(ribCageKey, ribCage, factor)],
      abscissa,
    },
  ];
}

const abdomen = "displaced by the abdomen";
const ribCageKey = "rib cage volume";
const ribCage = "displaced by the rib cage";

/** Returns the part of the lung volume that the abdomen does not displace [m^3], or nothing for other scenes. */
function ribCageVolume({ measures }: Frame): number[] {
  const valueOf = (wanted: string) => measures.find(({ name }) => name === wanted)?.value;
  const [all, below] = [valueOf("lung volume"), valueOf(abdomen)];
  return all === undefined || below === undefined ? [] : [all - below];
}

/**
 * The Campbell diagram: lung volume over pleural pressure, for the static curves of lungs and chest wall behind it;
 * nothing for other scenes.
 */
export function campbellGraph({ measures }: Frame): GraphSpec[] {
  const volume = measures.find(({ name }) => name === "lung volume");
  const pressure = measures.find(({ name }) => name === "pleural pressure");
  if (volume === undefined || pressure === undefined) return [];
  const [unit, factor] = displayUnit("m^3");
  const abscissa = { ...curve(measureKey(pressure.name), pressure.name, 1 / cmH2O), unit: "cmH₂O" };
  const curves = [curve(measureKey(volume.name), volume.name, factor)];
  return [{ id: "campbell", title: "Campbell diagram", help: campbellHelp, unit, curves, abscissa }];
}

const campbellHelp = "The area between the curves is the work of a breath";

/** The descent of each dome, as M-mode ultrasound shows it. */
function domes(frame: Frame): GraphSpec[] {
  const curves = domeHeights(frame).map(({ key, name }) => curve(key, name, -1000));
  return curves.length === 0 ? [] : [{ id: "domes", title: "M-mode: descent", help: domeHelp, unit: "mm", curves }];
}

function probes({ probes }: Frame): GraphSpec[] {
  const curves = probes.filter((probe) => !isDome(probe)).map(({ name }) => curve(probeKey(name), name, 1000));
  return curves.length === 0
    ? []
    : [{ id: "probes", title: "Probes: upward displacement", help: probeHelp, unit: "mm", curves }];
}

/** The descent is defined as in `phrenic physiology`. */
export const domeHelp =
  "Descent of the highest point of each side from its height at rest; the highest point may change";
/** Explanation of the probes' graph. */
export const probeHelp = "Upward displacement of a fixed vertex from rest";

/**
 * Returns the height of each dome above rest [m], from the scene's measures or, without these, from probes of that
 * name.
 */
export function domeHeights({ measures, probes }: Frame): { key: string; name: string; height: number }[] {
  return [
    ...measures.filter(isDomeHeight).map(({ name, value }) => ({ key: measureKey(name), name, height: value })),
    ...probes.filter(isDome).map(({ name, dz }) => ({ key: probeKey(name), name, height: dz })),
  ];
}

const isDome = ({ name }: { name: string }) => /\bdome\b/.test(name);
const isDomeHeight = ({ name, unit }: { name: string; unit: string }) => unit === "m" && /\bdome$/.test(name);

function curve(key: string, name: string, factor: number): Curve {
  return { key, name, factor };
}

function capital(words: string): string {
  return words.charAt(0).toUpperCase() + words.slice(1);
}
