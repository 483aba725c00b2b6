import type { Frame } from "../gen/phrenic/v1/frames_pb";
import { type TimeSeries, valueAt } from "../state/time_series";
import type { MotionKeys } from "./breath_motion";
import { domeHeights, graphsOf, type GraphSpec, measureKey } from "./catalogue";
import { cmH2O } from "./units";
import { t } from "../language/translate";

/**
 * Returns the graphs of the student view: lung volume, and the height of the domes and the pressure around the lungs.
 */
export function studentGraphs(frame: Frame): { volume: GraphSpec | undefined; others: GraphSpec[] } {
  const all = graphsOf(frame);
  const others = [domeGraph(frame), pressureGraph(all)].filter((each) => each !== undefined);
  const known = all.find(({ unit, abscissa }) => unit === "l" && abscissa === undefined);
  return { volume: known && { ...known, title: "Air in the lungs" }, others };
}

function domeGraph(frame: Frame): GraphSpec | undefined {
  const curves = domeHeights(frame).map(({ key, name }) => ({ key, name, factor: 1000 }));
  const help = "Height of the top of each dome above its place at rest; it falls when the diaphragm contracts";
  return curves.length === 0
    ? undefined
    : { id: "dome-height", title: "Height of the domes", help, unit: "mm", curves };
}

function pressureGraph(all: GraphSpec[]): GraphSpec | undefined {
  const known = all.find(({ id }) => id === "pressure");
  const curves = (known?.curves ?? []).filter(({ name }) => /pleural|abdominal/.test(name) && !/left/.test(name));
  const words: Record<string, string> = {
    "pleural pressure": "around the lungs",
    "abdominal pressure": "in the belly",
  };
  if (curves.length === 0) return undefined;
  const named = curves.map(({ key, name }) => ({ key, name: words[name] ?? name, factor: 1 / cmH2O }));
  return { id: "pressures", title: "Pressure", unit: "cmH₂O", curves: named };
}

/** What a user can predict: a measure, as it is drawn. */
export interface PredictionSubject {
  key: string;
  /** Name of the measure, as lessons name it. */
  measure: string;
  title: string;
  unit: string;
  /** From SI to the unit. */
  factor: number;
  /** Room below and above the values of the last breaths, what an arrow key changes, and decimals, in the unit. */
  below: number;
  above: number;
  nudge: number;
  digits: number;
}

/** Returns what can be predicted in a scene: the air in the lungs, each dome, and the pressure around the lungs. */
export function predictionSubjects(frame: Frame): PredictionSubject[] {
  const { volume } = studentGraphs(frame);
  const air = volume?.curves.slice(0, 1) ?? [];
  const pressures = frame.measures.filter(({ name, unit }) => name === "pleural pressure" && unit === "Pa");
  return [
    ...air.map(({ key, name, factor }) => {
      return { key, measure: name, title: "Air in the lungs", unit: "l", factor, ...room(0.5, 1, 0.05, 2) };
    }),
    ...domeHeights(frame).map(({ key, name }) => {
      return { key, measure: name, title: name, unit: "mm", factor: 1000, ...room(25, 10, 1, 1) };
    }),
    ...pressures.map(({ name }) => {
      const numbers = { factor: 1 / cmH2O, ...room(8, 3, 0.5, 1) };
      return { key: measureKey(name), measure: name, title: "Pressure around the lungs", unit: "cmH₂O", ...numbers };
    }),
  ];
}

function room(below: number, above: number, nudge: number, digits: number) {
  return { below, above, nudge, digits };
}

/** Returns where the lung volume and the domes of a frame are in a time series; undefined without a lung volume. */
export function motionKeys(frame: Frame): MotionKeys | undefined {
  const { volume } = studentGraphs(frame);
  if (volume === undefined) return undefined;
  return { volume: volume.curves[0].key, domes: domeHeights(frame).map(({ key, name }) => ({ key, name })) };
}

const besideKey = (key: string) => `beside ${key}`;

/** Returns a graph with a dashed curve of the session beside for each curve. */
export function besideGraph(spec: GraphSpec, here: string, beside: string): GraphSpec {
  const single = spec.curves.length === 1;
  const name = (who: string, curve: string) => (single ? who : `${t(curve)}, ${who}`);
  const first = spec.curves.map((curve, order) => ({ ...curve, name: name(here, curve.name), order }));
  const second = spec.curves.map(({ key, name: curve, factor }, order) => {
    return { key: besideKey(key), name: name(beside, curve), factor, order, dashed: true };
  });
  return { ...spec, curves: [...first, ...second] };
}

/** Fills `joined` with the last `span` seconds of both series, the second interpolated to the times of the first. */
export function joinSeries(joined: TimeSeries, here: TimeSeries, beside: TimeSeries, span: number): void {
  joined.clear();
  const end = Math.min(here.times.at(-1) ?? 0, beside.times.at(-1) ?? 0);
  const start = Math.max(end - span, beside.times[0] ?? 0);
  for (let i = here.indexAt(start); i < here.times.length && here.times[i] <= end; i++) {
    const time = here.times[i];
    const own = [...here.series].map(([key, values]): [string, number] => [key, values[i]]);
    const others = [...beside.series.keys()].map((key): [string, number] => [
      besideKey(key),
      valueAt(beside, key, time),
    ]);
    joined.add(time, [...own, ...others]);
  }
}
