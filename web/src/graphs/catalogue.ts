import type { Frame } from "../gen/phrenic/v1/frames_pb";
import { displayUnit } from "./units";

/** One line of a graph: where its values are kept, and what they are multiplied by to be in the graph's unit. */
export interface Curve {
  key: string;
  name: string;
  factor: number;
}

/** A graph that a scene offers: curves over time, or one curve over another. */
export interface GraphSpec {
  id: string;
  title: string;
  /** What it is, where its title leaves that open. */
  help?: string;
  unit: string;
  curves: Curve[];
  /** Of a loop: what runs to the right, and its unit. */
  abscissa?: Curve & { unit: string };
}

/** The values of a frame by the keys of curves, SI. */
export function valuesOf(frame: Frame): [key: string, value: number][] {
  return [
    ...frame.measures.map(({ name, value }): [string, number] => [measureKey(name), value]),
    ...frame.probes.map(({ name, dz }): [string, number] => [probeKey(name), dz]),
    ["breath", frame.breath],
  ];
}

const measureKey = (name: string) => `measure ${name}`;
const probeKey = (name: string) => `probe ${name}`;

/** The graphs of whatever measures and probes come with the frames, most telling first. */
export function graphsOf(frame: Frame): GraphSpec[] {
  const [volume, ...volumes] = byUnit(frame, "m^3", "Volume", false);
  return [
    ...(volume === undefined ? [] : [volume]),
    ...byUnit(frame, "m^3/s", "Flow", true),
    ...domes(frame),
    ...byUnit(frame, "Pa", "Pressure", true),
    ...loop(frame),
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

/** Measures of one unit in one graph, or in one each where they have little in common but the unit. */
function byUnit({ measures }: Frame, unit: string, title: string, together: boolean): GraphSpec[] {
  const [familiar, factor] = displayUnit(unit);
  const curves = measures
    .filter((each) => each.unit === unit && !isDomeHeight(each))
    .map(({ name }) => curve(measureKey(name), name, factor));
  if (curves.length === 0) return [];
  if (together && curves.length > 1)
    return [{ id: title.toLowerCase(), title: `${title}s`.replace(/ys$/, "ies"), unit: familiar, curves }];
  return curves.map((each) => ({ id: each.key, title: capital(each.name), unit: familiar, curves: [each] }));
}

/** Volume over the pressure around the lungs: the area inside is work. */
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

/** What M-mode ultrasound shows: how far each dome has come down. */
function domes(frame: Frame): GraphSpec[] {
  const curves = domeHeights(frame).map(({ key, name }) => curve(key, name, -1000));
  return curves.length === 0 ? [] : [{ id: "domes", title: "M-mode: descent", help: domeHelp, unit: "mm", curves }];
}

function probes({ probes }: Frame): GraphSpec[] {
  const curves = probes.filter((probe) => !isDome(probe)).map(({ name }) => curve(probeKey(name), name, 1000));
  return curves.length === 0 ? [] : [{ id: "probes", title: "Probes: upward", help: probeHelp, unit: "mm", curves }];
}

/** What a dome's descent is: with `phrenic physiology` it is the same. */
export const domeHelp =
  "How far the highest point of each side is below where it was at rest, whichever point that is now";
export const probeHelp = "How far one vertex each, always the same, is above where it rests";

/** How high each dome is above its rest [m], by the scene's measures or, where it has none, its probes of that name. */
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
