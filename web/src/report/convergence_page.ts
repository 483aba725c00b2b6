import { dot, frame, ruleX } from "@observablehq/plot";
import { make } from "../dom/elements";
import { ConvergenceRowSchema, type ConvergenceTable } from "../gen/phrenic/v1/uncertainty_pb";
import { drawPlot, ink } from "./axes";
import { figure } from "./figure";
import { formatDigits } from "./format";
import { seriesName } from "./names";
import { runsSentence } from "./runs_sentence";
import { tableOf } from "./table";

/** Returns plot and table of a convergence study. */
export function convergenceParts(table: ConvergenceTable): HTMLElement[] {
  return [
    make("p", { className: "advice" }, largestChange(table)),
    make("p", {}, runsSentence(table)),
    ...convergencePlots(table),
    make("h2", {}, "Tables"),
    tableOf("Outputs", ConvergenceRowSchema, table.rows),
  ];
}

/** Returns "The largest change is 1.2 % of shortening, mesh 4 mm." */
export function largestChange({ rows }: ConvergenceTable): string {
  const known = rows.filter(({ varied, changePercent }) => varied !== "as it is" && changePercent !== undefined);
  if (known.length === 0) return "Nothing was varied.";
  const most = known.reduce((a, b) => (Math.abs(b.changePercent!) > Math.abs(a.changePercent!) ? b : a));
  return `The largest change is ${formatDigits(most.changePercent!, 2)} %, of ${most.output} with ${most.varied} ${seriesName(most.to)}.`;
}

/** Plots the change of each output with each variation. */
export function convergencePlots({ rows }: ConvergenceTable): HTMLElement[] {
  const points = rows.flatMap(({ varied, to, output, changePercent }) =>
    varied === "as it is" || changePercent === undefined
      ? []
      : [{ at: `${varied} ${varied === "integrator" ? seriesName(to) : to}`, output, x: changePercent }],
  );
  if (points.length === 0) return [];
  const places = [...new Set(points.map(({ at }) => at))];
  const most = Math.max(...points.map(({ x }) => Math.abs(x)), 1e-9);
  const title = "Change of the outputs.";
  const drawn = drawPlot(title, {
    height: 90 + 34 * places.length,
    marginTop: 12,
    marginLeft: 260,
    x: { label: "Change from the scene as it is [%]", domain: [-1.1 * most, 1.1 * most], grid: true },
    y: { type: "point", domain: places, label: null, tickSize: 0, grid: true },
    color: { type: "identity" },
    marks: [
      frame({ stroke: "#8b949e" }),
      ruleX([0], { stroke: ink }),
      dot(points, { x: "x", y: "at", stroke: "#00609f", strokeWidth: 2, r: 5, title: "output" }),
    ],
  });
  return [figure(title, "One point per output; the table names them.", drawn)];
}
