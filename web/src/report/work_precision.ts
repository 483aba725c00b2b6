import { dot, frame, line, type Markish, pointer, ruleX, ruleY, text, tip } from "@observablehq/plot";
import type { ErrorRow, ErrorTable } from "../gen/phrenic/v1/study_results_pb";
import { drawPlot, faint, ink, isNear, isPositive, logDomain, logScale, seriesScales } from "./axes";
import { directLabels, type LabelledLine } from "./direct_labels";
import { figure } from "./figure";
import { count, formatDigits } from "./format";
import { seriesName, seriesStyles } from "./names";

/** The error measure of a diagram. */
export type Measure = "errorRmsMm" | "errorMaxMm";

/** A completed run with an error above that of the reference. */
export interface Run {
  id: string;
  x: number;
  y: number;
  row: ErrorRow;
}

/** Returns the runs that have both an error and a value `x`. */
export function runsOf(rows: ErrorRow[], x: (row: ErrorRow) => number | undefined, measure: Measure): Run[] {
  return rows.flatMap((row) => {
    const [at, error] = [x(row), row[measure]];
    return isPositive(at) && isPositive(error) ? [{ id: row.integrator, x: at, y: error, row }] : [];
  });
}

/** Returns one labelled curve per integrator. */
export function linesOf(runs: Run[]): LabelledLine[] {
  return [...new Set(runs.map(({ id }) => id))].map((id) => {
    const points = runs.filter((run) => run.id === id).map(({ x, y }) => ({ x, y }));
    return { id, name: seriesName(id), points };
  });
}

/** Returns curves, a symbol per point and tooltips: one series per integrator. */
export function seriesMarks(runs: Run[]): Markish[] {
  return [
    line(runs, { x: "x", y: "y", z: "id", stroke: "id", strokeWidth: 2.5 }),
    dot(runs, { x: "x", y: "y", fill: "id", symbol: "id", r: 6, stroke: "white", strokeWidth: 1 }),
    tip(runs, pointer({ x: "x", y: "y", title: ({ row }: Run) => tooltip(row), fontSize: 14 })),
  ];
}

function tooltip(row: ErrorRow): string {
  const rms = row.errorRmsMm === undefined ? "–" : formatDigits(row.errorRmsMm, 3);
  const most = row.errorMaxMm === undefined ? "–" : formatDigits(row.errorMaxMm, 3);
  const cpu = row.cpuPerSecond === undefined ? "–" : formatDigits(row.cpuPerSecond, 3);
  return `${seriesName(row.integrator)} at ${formatDigits(1e3 * row.timeStepS, 3)} ms
RMS error ${rms} mm, largest ${most} mm
${cpu} CPU s per simulated s`;
}

/** Plots the error against run time; lower left is better. */
export function workPrecision(table: ErrorTable, measure: Measure): HTMLElement {
  const runs = runsOf(table.rows, (row) => row.cpuPerSecond, measure);
  const what = measure === "errorRmsMm" ? "RMS error" : "Largest error";
  const title = `${what} against run time.`;
  if (runs.length === 0) return figure(title, `No run has an error to show. ${omittedRuns(table.rows, runs)}`);
  const own = (measure === "errorRmsMm" ? table.reference?.errorRmsMm : table.reference?.errorMaxMm) ?? 0;
  const [xs, ys] = [runs.map(({ x }) => x), runs.map(({ y }) => y)];
  const [paceShown, ownShown] = [isNear(1, xs, 1.5), isNear(own, ys, 3)];
  const x = logDomain(paceShown ? [...xs, 1] : xs);
  const y = logDomain(ownShown ? [...ys, own] : ys);
  const front = measure === "errorRmsMm" ? runs.filter(({ row }) => row.pareto).sort((a, b) => a.x - b.x) : [];
  const drawn = drawPlot(`${title} ${bestSummary(runs)}`, {
    ...seriesScales(seriesStyles(table.rows.map(({ integrator }) => integrator))),
    height: 648,
    marginTop: 44,
    x: logScale("CPU time per simulated second [s]", x),
    y: logScale(`${what} [mm]`, y),
    marks: [
      frame({ stroke: "#8b949e" }),
      ...(paceShown ? realTime() : []),
      ...(ownShown ? referenceRule(own, paceShown && isLeft(1, x)) : []),
      line(front, { x: "x", y: "y", stroke: ink, strokeOpacity: 0.13, strokeWidth: 16, strokeLinecap: "round" }),
      ...seriesMarks(runs),
      dot(front, { x: "x", y: "y", r: 10, stroke: ink, strokeWidth: 1.8 }),
      directLabels(linesOf(runs)),
    ],
  });
  const sentences = [
    "Lower is more accurate, further left is faster; each dot has half the time step of the previous one.",
    front.length > 0
      ? "Rings on the grey band mark the Pareto front: no other run is both faster and more accurate."
      : "",
    paceShown ? "" : `All runs are much ${xs[0] < 1 ? "faster" : "slower"} than real time.`,
    ownShown || !isPositive(own)
      ? ""
      : `The reference's own error, ${formatDigits(own, 3)} mm, is outside of the plot.`,
    omittedRuns(table.rows, runs),
  ];
  return figure(title, sentences.filter(Boolean).join(" "), drawn);
}

const isLeft = (value: number, [low, high]: [number, number]) => value / low < Math.sqrt(high / low);

function realTime(): Markish[] {
  return [
    ruleX([1], { stroke: ink, strokeWidth: 1.5, strokeDasharray: "7 4" }),
    text(["real time"], { x: [1], frameAnchor: "top", dy: -11, fill: ink, fontSize: 14 }),
  ];
}

function referenceRule(own: number, onTheRight: boolean): Markish[] {
  const words = `the reference's own error, ${formatDigits(own, 2)} mm`;
  const side = onTheRight ? ({ frameAnchor: "right", dx: -10 } as const) : ({ frameAnchor: "left", dx: 10 } as const);
  const label = { ...side, y: [own], dy: -11, textAnchor: onTheRight ? "end" : "start" } as const;
  return [
    ruleY([own], { stroke: faint, strokeWidth: 1.5, strokeDasharray: "2 4" }),
    text([words], { ...label, fill: ink, fontSize: 14, stroke: "white", strokeWidth: 4 }),
  ];
}

/** Returns which runs are not drawn, and why. */
export function omittedRuns(rows: ErrorRow[], runs: Run[]): string {
  const drawn = new Set(runs.map(({ row }) => row));
  const missing = rows.filter((row) => !drawn.has(row));
  if (missing.length === 0) return "";
  const below = missing.filter(({ verdict }) => verdict.startsWith("below"));
  const rest = [
    ...new Set(missing.filter((row) => !below.includes(row)).map(({ integrator }) => seriesName(integrator))),
  ];
  const belowWho = [...new Set(below.map(({ integrator }) => seriesName(integrator)))].join(", ");
  const sentences = [
    below.length === 0 ? "" : `${count(below.length, "run")} (${belowWho}) too close to the reference to be measured.`,
    rest.length === 0 ? "" : `${count(missing.length - below.length, "run")} (${rest.join(", ")}) without a result.`,
  ];
  return `Not drawn: ${sentences.filter(Boolean).join(" ")}`;
}

function bestSummary(runs: Run[]): string {
  const best = runs.reduce((a, b) => (b.y < a.y ? b : a));
  const fastest = runs.reduce((a, b) => (b.x < a.x ? b : a));
  return (
    `The least error is ${formatDigits(best.y, 3)} mm, by ${seriesName(best.id)}; ` +
    `the fastest run is ${seriesName(fastest.id)} with ${formatDigits(fastest.y, 3)} mm.`
  );
}
