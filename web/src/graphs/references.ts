import {
  type HealthRange,
  HealthRange_Change,
  type StaticCurve,
  StaticCurve_Kind,
} from "../gen/phrenic/v1/references_pb";
import { decimal, t } from "../language/translate";
import type { GraphSpec } from "./catalogue";
import { cmH2O } from "./units";
import type { GraphData } from "./window";

/** What graphs show beside the breath of a session, now. */
export interface References {
  ranges: HealthRange[];
  curves: StaticCurve[];
  /** Name of the active preset; empty if none is. */
  breath: string;
  /** Length of a breath [s]. */
  period: number;
}

/** References with what draws them, which is loaded with the first of them. */
export interface ShownReferences extends References {
  backdropOf(spec: GraphSpec, data: GraphData, references: References): Backdrop | undefined;
}

/** A point of a graph: its abscissa and ordinate, in the units of the graph. */
export type Point = [x: number, y: number];

/** What is drawn behind the curves of a graph, in its units. */
export interface Backdrop {
  /** Ranges of values across the whole graph. */
  bands: { low: number; high: number }[];
  /** Areas, and curves that do not move. */
  areas: { points: Point[]; order: number }[];
  lines: { points: Point[]; order: number; dashed: boolean }[];
  /** Explanation below the graph. */
  words: string;
}

/** The breath whose ranges are shown while no preset with ranges is active. */
const quiet = "quiet";

/**
 * Returns what is behind a graph: the ranges of health of its measures, or the static curves of a Campbell diagram;
 * undefined if nothing is.
 */
export function backdropOf(spec: GraphSpec, data: GraphData, references: References): Backdrop | undefined {
  if (spec.id === "campbell") return campbellBackdrop(data, references);
  if (spec.abscissa !== undefined) return undefined;
  const bands = spec.curves.flatMap(({ key, factor }, i) =>
    rangesOf(key, references).map((range) => bandOf(range, factor, data.curves[i] ?? [])),
  );
  const shown = bands.filter(({ low }) => Number.isFinite(low));
  if (shown.length === 0) return undefined;
  const sizes = spec.curves.flatMap(({ key, factor }) =>
    rangesOf(key, references).map(({ low, high }) => [low, high].map((each) => short(Math.abs(factor) * each))),
  );
  const [[from, to]] = sizes;
  return {
    bands: shown,
    areas: [],
    lines: [],
    words: t("Shaded: where a healthy breath ends, {0} to {1} {2} from its start", from, to, spec.unit),
  };
}

/** Returns the ranges of a measure in the breath that is chosen, or else in a quiet one. */
function rangesOf(key: string, { ranges, breath }: References): HealthRange[] {
  const own = ranges.filter(({ measure }) => key === `measure ${measure}`);
  const chosen = own.filter((range) => range.breath === breath);
  return chosen.length > 0 ? chosen : own.filter((range) => range.breath === quiet);
}

/** Returns where the breath ends, from where it starts: the smallest or the largest value that is shown. */
function bandOf(range: HealthRange, factor: number, values: number[]): { low: number; high: number } {
  const rises = range.change === HealthRange_Change.RISE;
  const extreme = rises === factor > 0 ? Math.min : Math.max;
  const start = values.reduce((a, b) => extreme(a, b), values[0] ?? NaN);
  const ends = [range.low, range.high].map((each) => start + (rises ? 1 : -1) * factor * each);
  return { low: Math.min(...ends), high: Math.max(...ends) };
}

/** The work of one inspiration [J]: against the recoil of lungs and chest wall, and against resistance. */
export interface WorkOfBreathing {
  elastic: number;
  resistive: number;
}

/** Returns the pressure of a static curve at a volume [Pa], interpolated; that of an end beyond it. */
export function pressureAt({ volumes, pressures }: StaticCurve, volume: number): number {
  const next = volumes.findIndex((each) => each > volume);
  if (next === 0) return pressures[0];
  if (next < 0) return pressures[pressures.length - 1];
  const part = (volume - volumes[next - 1]) / (volumes[next] - volumes[next - 1]);
  return pressures[next - 1] + part * (pressures[next] - pressures[next - 1]);
}

/**
 * Returns the work of the inspirations in a course of volumes [m^3] and pleural pressures [Pa], by Campbell: the areas
 * between the curves of chest wall and lungs, and between that of the lungs and the breath.
 */
export function workOfBreathing(
  volumes: number[],
  pressures: number[],
  lung: StaticCurve,
  wall: StaticCurve,
): WorkOfBreathing {
  let [elastic, resistive] = [0, 0];
  for (let i = 1; i < volumes.length; i++) {
    const gained = volumes[i] - volumes[i - 1];
    if (gained <= 0) continue;
    const middle = (volumes[i] + volumes[i - 1]) / 2;
    const recoil = pressureAt(lung, middle);
    elastic += gained * (pressureAt(wall, middle) - recoil);
    resistive += gained * (recoil - (pressures[i] + pressures[i - 1]) / 2);
  }
  return { elastic, resistive };
}

function campbellBackdrop(data: GraphData, { curves, period }: References): Backdrop | undefined {
  const lung = curves.find(({ kind }) => kind === StaticCurve_Kind.LUNG_RECOIL);
  const wall = curves.find(({ kind }) => kind === StaticCurve_Kind.CHEST_WALL);
  const end = data.times.at(-1);
  if (lung === undefined || wall === undefined || end === undefined) return undefined;
  const first = data.times.findIndex((time) => time >= end - period);
  const volumes = data.curves[0].slice(first).map((litres) => litres / 1000);
  const pressures = (data.abscissa ?? []).slice(first).map((each) => each * cmH2O);
  const [least, most] = [Math.min(...volumes), Math.max(...volumes)];
  const { elastic, resistive } = workOfBreathing(volumes, pressures, lung, wall);
  const point = (curve: StaticCurve, volume: number): Point => [pressureAt(curve, volume) / cmH2O, 1000 * volume];
  const along = (curve: StaticCurve, from: number, to: number) =>
    Array.from({ length: 25 }, (_, i) => point(curve, from + ((to - from) * i) / 24));
  const room = 0.6 * (most - least) + 1e-4;
  const [low, high] = [least - room, most + room];
  const inspired = volumes.flatMap((volume, i): Point[] =>
    i > 0 && volume > volumes[i - 1] ? [[pressures[i] / cmH2O, 1000 * volume]] : [],
  );
  return {
    bands: [],
    areas: [
      { points: [...along(wall, least, most), ...along(lung, most, least)], order: 1 },
      { points: [...inspired.sort((a, b) => a[1] - b[1]), ...along(lung, most, least)], order: 2 },
    ],
    lines: [
      { points: along(lung, low, high), order: 1, dashed: false },
      { points: along(wall, low, high), order: 3, dashed: true },
    ],
    words: t(
      "Line: recoil of the lungs. Dashed: relaxed chest wall. Work of a breath: {0} J against recoil, {1} J against resistance",
      short(elastic),
      short(resistive),
    ),
  };
}

const short = (value: number) => decimal(String(Number(value.toPrecision(2))));
