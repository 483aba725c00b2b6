import { dot, frame, line, type Markish, pointer, rect, text, tip } from "@observablehq/plot";
import { make } from "../dom/elements";
import type { StabilityRow, StabilityTable } from "../gen/phrenic/v1/study_results_pb";
import { drawPlot, half, ink, isPositive, logScale } from "./axes";
import { type Cell, cellsOf, edgesOf } from "./cells";
import { formatDigits } from "./format";
import { seriesName } from "./names";

/** The data of the map of one integrator. */
export interface StabilityMapData {
  integrator: string;
  /** True if time steps are relative to the predicted limit; otherwise in milliseconds. */
  relative: boolean;
  cells: Cell[];
  predicted: { x: number; y: number }[];
  measured: { x: number; y: number }[];
}

const verdicts: Record<string, { color: string; letter: string }> = {
  stable: { color: "#a9d5f5", letter: "S" },
  damped: { color: "#d8ecd0", letter: "d" },
  grown: { color: "#f9cfa0", letter: "g" },
  diverged: { color: "#f4a27c", letter: "×" },
  stopped: { color: "#f6e08a", letter: "■" },
  "out of time": { color: "#e3e5e8", letter: "t" },
};
const unknown = { color: "#ffffff", letter: "?" };
const verdictOf = (verdict: string) => verdicts[verdict] ?? unknown;

/** Returns one map for each integrator with data. */
export function stabilityMaps({ map, limits }: StabilityTable): StabilityMapData[] {
  return [...new Set(map.map(({ integrator }) => integrator))].flatMap((integrator) => {
    const own = limits.filter((limit) => limit.integrator === integrator);
    const rows = map.filter((row) => row.integrator === integrator && isPositive(row.stiffness));
    const unit = new Map(
      own.flatMap((limit) => (isPositive(limit.predictedS) ? [[limit.stiffness, limit.predictedS]] : [])),
    );
    const relative = rows.every(({ stiffness }) => unit.has(stiffness));
    const scaled = (seconds: number, stiffness: number) => (relative ? seconds / unit.get(stiffness)! : 1e3 * seconds);
    const points = rows.flatMap((row) =>
      isPositive(row.timeStepS) ? [{ x: scaled(row.timeStepS, row.stiffness), y: row.stiffness, row }] : [],
    );
    const at = (value: number | undefined, stiffness: number) =>
      isPositive(value) && (!relative || unit.has(stiffness)) ? [{ x: scaled(value, stiffness), y: stiffness }] : [];
    if (points.length === 0) return [];
    return {
      integrator,
      relative,
      cells: cellsOf(points),
      predicted: own.flatMap(({ predictedS, stiffness }) => at(predictedS, stiffness)),
      measured: own.flatMap(({ measuredS, stiffness }) => at(measuredS, stiffness)),
    };
  });
}

/** Draws the stability map of one integrator. */
export function stabilityMap(data: StabilityMapData): HTMLElement {
  const { integrator, relative, cells } = data;
  const x: [number, number] = [Math.min(...cells.map(({ x1 }) => x1)), Math.max(...cells.map(({ x2 }) => x2))];
  const y: [number, number] = [Math.min(...cells.map(({ y1 }) => y1)), Math.max(...cells.map(({ y2 }) => y2))];
  const stable = cells.filter(({ row }) => row.verdict === "stable" || row.verdict === "damped").length;
  const rows = new Set(cells.map(({ row }) => row.stiffness)).size;
  const label = `${seriesName(integrator)}: ${stable} of ${cells.length} runs stay stable, over stiffness and time step.`;
  const drawn = drawPlot(label, {
    width: half,
    height: 90 + 34 * Math.max(3, rows),
    marginLeft: 64,
    x: { ...logScale(relative ? "Time step over predicted limit" : "Time step [ms]", x), grid: false },
    y: { ...logScale("Stiffness, times the scene's", y), grid: false, labelOffset: 58 },
    marks: mapMarks(data, y),
  });
  return make("div", {}, make("h3", {}, seriesName(integrator)), drawn);
}

function mapMarks({ cells, predicted, measured }: StabilityMapData, y: [number, number]): Markish[] {
  const sides = { x1: "x1", x2: "x2", y1: "y1", y2: "y2" };
  const limit = limitLine(predicted, y);
  return [
    rect(cells, { ...sides, fill: ({ row }: Cell) => verdictOf(row.verdict).color, stroke: "white", inset: 0.5 }),
    text(cells, {
      x: (cell: Cell) => letterX(cell, [...predicted, ...measured]),
      y: "y",
      text: ({ row }: Cell) => verdictOf(row.verdict).letter,
      fill: ink,
      fontSize: 14,
    }),
    frame({ stroke: "#8b949e" }),
    line(limit, { x: "x", y: "y", stroke: ink, strokeWidth: 3, strokeDasharray: "8 5", clip: true }),
    dot(measured, { x: "x", y: "y", r: 6, fill: ink, stroke: "white", strokeWidth: 1.5, clip: true }),
    tip(cells, pointer({ x: "x", y: "y", title: ({ row }: Cell) => tooltip(row), fontSize: 14 })),
  ];
}

/** Returns the x position of a cell's letter: the centre, or beside a limit that is drawn there. */
function letterX({ x1, x2, y1, y2, x }: Cell, limits: { x: number; y: number }[]): number {
  const over = limits.some((limit) => limit.x > x1 && limit.x < x2 && limit.y > y1 && limit.y < y2);
  return over ? x1 ** 0.55 * x ** 0.45 : Math.sqrt(x1 * x2);
}

/** Returns the predicted limit through all rows, extended to the edges of the map. */
function limitLine(points: { x: number; y: number }[], [low, high]: [number, number]): { x: number; y: number }[] {
  if (points.length === 0) return [];
  const sorted = [...points].sort((a, b) => a.y - b.y);
  const ys = edgesOf(sorted.map(({ y }) => y));
  const xs = sorted.map(({ x }) => x);
  const steep = xs.length > 1 ? Math.sqrt(xs[1] / xs[0]) : 1;
  const last = xs.length > 1 ? Math.sqrt(xs[xs.length - 1] / xs[xs.length - 2]) : 1;
  const start = { x: xs[0] / steep, y: Math.max(low, ys[0]) };
  return [start, ...sorted, { x: xs[xs.length - 1] * last, y: Math.min(high, ys[ys.length - 1]) }];
}

function tooltip(row: StabilityRow): string {
  const lines = [
    `${seriesName(row.integrator)}, ${formatDigits(row.stiffness)} times as stiff, ${formatDigits(1e3 * row.timeStepS, 3)} ms`,
    row.divergedAtS === undefined ? row.verdict : `${row.verdict} at ${formatDigits(row.divergedAtS, 3)} s`,
    row.where,
    row.energyRatio === undefined ? "" : `largest energy ${formatDigits(row.energyRatio, 3)} times the expected`,
  ];
  return lines.filter(Boolean).join("\n");
}

/** The legend of the colours, letters and lines that occur. */
export function verdictKey({ map, limits }: StabilityTable): HTMLElement {
  const present = new Set(map.map(({ verdict }) => verdict));
  const order = [...new Set([...Object.keys(verdicts), ...present])].filter((verdict) => present.has(verdict));
  const items = order.map((verdict) => {
    const swatch = make("span", { className: "swatch" }, verdictOf(verdict).letter);
    swatch.style.backgroundColor = verdictOf(verdict).color;
    return make("li", {}, swatch, verdict || "no verdict");
  });
  if (limits.some(({ predictedS }) => predictedS !== undefined)) {
    items.push(make("li", {}, make("span", { className: "stroke" }), "predicted limit"));
  }
  if (limits.some(({ measuredS }) => measuredS !== undefined)) {
    items.push(make("li", {}, make("span", { className: "dots" }, "●"), "measured limit"));
  }
  return make("ul", { className: "cells" }, ...items);
}
