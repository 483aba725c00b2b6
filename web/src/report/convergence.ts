import { frame, line, type Markish, text } from "@observablehq/plot";
import type { ErrorTable } from "../gen/phrenic/v1/study_results_pb";
import { drawPlot, faint, logDomain, logScale, seriesScales } from "./axes";
import { directLabels } from "./direct_labels";
import { figure } from "./figure";
import { formatDigits } from "./format";
import { seriesName, seriesStyles } from "./names";
import { linesOf, omittedRuns, type Run, runsOf, seriesMarks } from "./work_precision";

interface Guide {
  order: number;
  points: { x: number; y: number }[];
}

/** Plots the error against the time step; the slope is the order of convergence. */
export function convergence(table: ErrorTable): HTMLElement | undefined {
  const runs = runsOf(table.rows, ({ timeStepS }) => 1e3 * timeStepS, "errorRmsMm");
  if (runs.length === 0) return undefined;
  const xs = runs.map(({ x }) => x);
  const y = logDomain(runs.map((run) => run.y));
  const [low, high] = logDomain(xs);
  // The slope guides are drawn to the right of all runs.
  const end = high * 10 ** Math.max(0.3, 0.18 * Math.log10(high / low));
  const guides = guidesIn(high, end, y);
  const title = "RMS error against time step.";
  const drawn = drawPlot(`${title} ${measuredOrders(runs)}`, {
    ...seriesScales(seriesStyles(table.rows.map(({ integrator }) => integrator))),
    height: 560,
    marginRight: 84,
    x: logScale("Time step [ms]", [low, end]),
    y: logScale("RMS error [mm]", y),
    marks: [
      frame({ stroke: "#8b949e" }),
      ...guides.flatMap(guideMarks),
      ...seriesMarks(runs),
      directLabels(linesOf(runs)),
    ],
  });
  const sentence =
    `Halving the step reduces an error of order p to 1/2^p: dashed guides have slopes 1, 2 and 4. ` +
    [measuredOrders(runs), omittedRuns(table.rows, runs)].filter(Boolean).join(" ");
  return figure(title, sentence.replace("1/2^p", "1/2ᵖ"), drawn);
}

/** Returns lines of slope 1, 2 and 4 from one point to the edge of the frame. */
export function guidesIn(from: number, to: number, [low, high]: [number, number]): Guide[] {
  const bottom = low * (high / low) ** 0.06;
  const rise = (high / low) ** 0.88;
  return [1, 2, 4].map((order) => {
    const x = Math.min(to, from * rise ** (1 / order));
    return {
      order,
      points: [
        { x: from, y: bottom },
        { x, y: bottom * (x / from) ** order },
      ],
    };
  });
}

function guideMarks({ order, points }: Guide): Markish[] {
  const [, end] = points;
  const label = { x: [end.x], y: [end.y], dx: 8, textAnchor: "start", fill: faint, fontSize: 14 } as const;
  return [
    line(points, { x: "x", y: "y", stroke: faint, strokeWidth: 1.5, strokeDasharray: "5 4" }),
    text([`order ${order}`], label),
  ];
}

/** Returns "Orders measured at the smallest steps: BDF2: 1.4; Velocity Verlet: 2." */
function measuredOrders(runs: Run[]): string {
  const last = new Map(runs.flatMap(({ id, row }) => (row.order === undefined ? [] : [[id, row.order]])));
  if (last.size === 0) return "";
  const words = [...last].map(([id, order]) => `${seriesName(id)}: ${formatDigits(order, 2)}`);
  return `Orders measured at the smallest steps: ${words.join("; ")}.`;
}
