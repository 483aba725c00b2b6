import { areaY, binX, frame, line, rectY, ruleX, ruleY } from "@observablehq/plot";
import { make } from "../dom/elements";
import {
  type BandCurve,
  type BandRow,
  BandRowSchema,
  InputRowSchema,
  type SampledOutput,
  type UncertaintyTable,
} from "../gen/phrenic/v1/uncertainty_pb";
import { drawPlot, half, ink } from "./axes";
import { figure } from "./figure";
import { formatDigits } from "./format";
import { runsSentence } from "./runs_sentence";
import { tableOf } from "./table";

const band = "#a9cbe5";
const middle = "#00609f";
const nominalColor = "#b23a12";

/** Returns plots and tables of an uncertainty study. */
export function uncertaintyParts(table: UncertaintyTable): HTMLElement[] {
  return [
    make("p", { className: "advice" }, ...table.bands.slice(0, 4).map((row) => make("p", {}, bandSentence(row)))),
    make("p", {}, runsSentence(table)),
    ...uncertaintyPlots(table),
    make("h2", {}, "Tables"),
    tableOf("Inputs", InputRowSchema, table.inputs),
    tableOf("Bands of the outputs", BandRowSchema, table.bands),
  ];
}

/** Returns "tidal-volume: 0.42 to 0.58 l in nine of ten runs, median 0.5". */
export function bandSentence({ output, unit, p5, p50, p95 }: BandRow): string {
  if (p5 === undefined || p50 === undefined || p95 === undefined) return `${output}: no run has a value.`;
  const of = unit === "1" ? "" : ` ${unit}`;
  return `${output}: ${formatDigits(p5, 3)} to ${formatDigits(p95, 3)}${of} in nine of ten runs, median ${formatDigits(p50, 3)}.`;
}

/** Returns the distribution of each output and the band of each measure over time. */
export function uncertaintyPlots(table: UncertaintyTable): HTMLElement[] {
  const rows = new Map(table.bands.map((row) => [row.output, row]));
  const tiles = table.samples.map((sample) => distribution(sample, rows.get(sample.output)));
  const curves = table.curves.filter(({ phase }) => phase.length > 0).map(bandCurve);
  const parts = [
    figure(
      "Outputs.",
      "Number of runs by value. Dashed: 5 and 95 %; blue stroke: median; red stroke: the scene's own inputs.",
      make("div", { className: "tiles" }, ...tiles),
    ),
  ];
  if (curves.length > 0) {
    parts.push(
      figure(
        "Measures in the course of the measured time.",
        "Median, and the band from 5 to 95 % of the runs at each part of it.",
        make("div", { className: "tiles" }, ...curves),
      ),
    );
  }
  return parts;
}

function distribution({ output, unit, values }: SampledOutput, row: BandRow | undefined): HTMLElement {
  const heading = make("h3", {}, `${output} [${unit}]`);
  if (values.length === 0 || row?.p5 === undefined || row.p95 === undefined || row.p50 === undefined)
    return make("div", {}, heading, make("p", { className: "none" }, "No run has a value."));
  const points = values.map((value) => ({ value }));
  const binned = binX({ y: "count" }, { x: { value: "value", thresholds: 20 } });
  const within = [{ x1: row.p5, x2: row.p95 }];
  const drawn = drawPlot(bandSentence(row), {
    width: half,
    height: 260,
    x: { label: null, ticks: 5, tickFormat: (value: number) => formatDigits(value, 3) },
    y: { label: "Runs", grid: true, ticks: 4 },
    color: { type: "identity" },
    marks: [
      frame({ stroke: "#8b949e" }),
      ruleY([0], { stroke: ink }),
      rectY(points, { ...binned, fill: band, inset: 0.5 }),
      ruleX(within, { x: "x1", stroke: middle, strokeDasharray: "4 4" }),
      ruleX(within, { x: "x2", stroke: middle, strokeDasharray: "4 4" }),
      ruleX([row.p50], { stroke: middle, strokeWidth: 3 }),
      ...(row.nominal === undefined ? [] : [ruleX([row.nominal], { stroke: nominalColor, strokeWidth: 2 })]),
    ],
  });
  return make("div", {}, heading, drawn);
}

function bandCurve({ measure, unit, phase, p5, p50, p95 }: BandCurve): HTMLElement {
  const points = phase.map((x, i) => ({ x, low: p5[i], middle: p50[i], high: p95[i] }));
  const drawn = drawPlot(`${measure}, with its band from 5 to 95 %.`, {
    width: half,
    height: 260,
    x: { label: "Part of the measured time", ticks: 5, grid: true },
    y: { label: null, ticks: 5, grid: true, tickFormat: (value: number) => formatDigits(value, 3) },
    color: { type: "identity" },
    marks: [
      frame({ stroke: "#8b949e" }),
      areaY(points, { x: "x", y1: "low", y2: "high", fill: band }),
      line(points, { x: "x", y: "middle", stroke: middle, strokeWidth: 2.5 }),
    ],
  });
  return make("div", {}, make("h3", {}, `${measure} [${unit}]`), drawn);
}
