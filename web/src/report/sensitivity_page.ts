import { barX, dot, frame, ruleX, text } from "@observablehq/plot";
import { make } from "../dom/elements";
import {
  FitRowSchema,
  IndexRowSchema,
  InputRowSchema,
  ScreeningRowSchema,
  type ScreeningRow,
  type SensitivityTable,
} from "../gen/phrenic/v1/uncertainty_pb";
import { drawPlot, half, ink } from "./axes";
import { figure } from "./figure";
import { formatDigits } from "./format";
import { runsSentence } from "./runs_sentence";
import { tableOf } from "./table";

const firstColor = "#00609f";
const totalColor = "#a9cbe5";

/** Returns advice, plots and tables of a sensitivity study. */
export function sensitivityParts(table: SensitivityTable): HTMLElement[] {
  return [
    make("p", { className: "advice" }, table.advice),
    make("p", {}, runsSentence(table)),
    ...sensitivityPlots(table),
    make("h2", {}, "Tables"),
    tableOf("Inputs", InputRowSchema, table.inputs),
    tableOf("Screening", ScreeningRowSchema, table.screening),
    tableOf("Sobol indices", IndexRowSchema, table.indices),
    tableOf("Polynomials", FitRowSchema, table.fits),
  ];
}

/** Returns the plots of the indices and of the screening. */
export function sensitivityPlots(table: SensitivityTable): HTMLElement[] {
  const outputs = [...new Set([...table.screening, ...table.indices].map(({ output }) => output))];
  const parts: HTMLElement[] = [];
  if (table.indices.length > 0) {
    const sentence = "Part of each output's variance: dark, by the input alone; pale, with its interactions.";
    const methods = [...new Set(table.indices.map(({ method }) => method))];
    const tiles = methods.flatMap((method) => outputs.map((output) => indexBars(table, output, method)));
    parts.push(figure("Sobol indices.", sentence, make("div", { className: "tiles" }, ...tiles)));
  }
  if (table.screening.length > 0) {
    const sentence =
      "Mean size of the elementary effects of each input, and their deviation: an input far to the right matters; one " +
      "that is high as well interacts with others, or its effect is not linear.";
    const tiles = outputs.map((output) => screeningPlot(table.screening.filter((row) => row.output === output)));
    parts.push(figure("Morris' screening.", sentence, make("div", { className: "tiles" }, ...tiles)));
  }
  return parts;
}

function indexBars(table: SensitivityTable, output: string, method: string): HTMLElement {
  const rows = table.indices.filter((row) => row.output === output && row.method === method);
  const fit = method === "chaos" ? table.fits.find((row) => row.output === output) : undefined;
  const predicted =
    fit?.predictedShare === undefined
      ? ""
      : `; predicts ${formatDigits(100 * fit.predictedShare, 3)} % of left-out runs`;
  const heading = make("h3", {}, `${output} (${method}${predicted})`);
  const known = rows.filter((row) => row.total !== undefined);
  if (known.length === 0) return make("div", {}, heading, make("p", { className: "none" }, "It does not vary."));
  const bars = known.map(({ input, first, total }) => ({ input, first: Math.max(0, first ?? 0), total: total ?? 0 }));
  const words = bars.map(({ input, first, total }) => `${input} ${percent(first)}, ${percent(total)}`).join("; ");
  const drawn = drawPlot(`Sobol indices of ${output}: ${words}.`, {
    width: half,
    height: 70 + 30 * bars.length,
    marginTop: 8,
    marginLeft: 190,
    x: { label: "Part of the variance", domain: [0, Math.max(1, ...bars.map(({ total }) => total)) * 1.15], ticks: 5 },
    y: { type: "band", domain: bars.map(({ input }) => input), label: null, tickSize: 0 },
    color: { type: "identity" },
    marks: [
      ruleX([0], { stroke: ink }),
      barX(bars, { x: "total", y: "input", fill: totalColor, inset: 3 }),
      barX(bars, { x: "first", y: "input", fill: firstColor, inset: 7 }),
      text(bars, { x: "total", y: "input", text: ({ total }) => percent(total), dx: 6, textAnchor: "start" }),
    ],
  });
  return make("div", {}, heading, drawn);
}

const percent = (part: number) => `${formatDigits(Math.round(1000 * part) / 10, 3)} %`;

function screeningPlot(rows: ScreeningRow[]): HTMLElement {
  const [{ output, unit }] = rows;
  const points = rows.flatMap(({ input, meanSize, deviation }) =>
    meanSize === undefined ? [] : [{ input, x: meanSize, y: deviation ?? 0 }],
  );
  const heading = make("h3", {}, `${output} [${unit}]`);
  const most = Math.max(...points.map(({ x, y }) => Math.max(x, y)), 0);
  if (most === 0) return make("div", {}, heading, make("p", { className: "none" }, "No input has an effect."));
  const words = points.map(({ input, x }) => `${input} ${formatDigits(x, 3)}`).join("; ");
  const drawn = drawPlot(`Mean size of the effects on ${output}: ${words}.`, {
    width: half,
    height: 320,
    x: { label: "Mean size", domain: [0, most * 1.45], ticks: 5, grid: true },
    y: { label: "Deviation", domain: [0, most * 1.05], ticks: 5, grid: true },
    color: { type: "identity" },
    marks: [
      frame({ stroke: "#8b949e" }),
      dot(points, { x: "x", y: "y", fill: firstColor, r: 5 }),
      text(points, { x: "x", y: "y", text: "input", dx: 9, textAnchor: "start", fill: ink, fontSize: 13 }),
    ],
  });
  return make("div", {}, heading, drawn);
}
