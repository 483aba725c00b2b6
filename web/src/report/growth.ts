import { dot, frame, line, pointer, text, tip } from "@observablehq/plot";
import type { CostTable } from "../gen/phrenic/v1/study_results_pb";
import { drawPlot, faint, isPositive, logDomain, logScale, seriesScales } from "./axes";
import { directLabels } from "./direct_labels";
import { figure } from "./figure";
import { formatDigits } from "./format";
import { seriesName, seriesStyles } from "./names";

interface Point {
  id: string;
  x: number;
  y: number;
}

/** Plots the cost of a step against the number of vertices, with the fitted power law. */
export function growth({ growth: rows, growthExponent }: CostTable): HTMLElement | undefined {
  const points = rows.flatMap(({ what, vertices, cpuUsPerStep }) =>
    isPositive(cpuUsPerStep) && vertices > 0n ? [{ id: what, x: Number(vertices), y: cpuUsPerStep }] : [],
  );
  if (points.length === 0) return undefined;
  const x = logDomain(points.map((point) => point.x));
  const fit = growthExponent === undefined ? [] : fitted(points, growthExponent);
  const ids = [...new Set(points.map(({ id }) => id))];
  const title = "CPU time of a step against the number of vertices.";
  const sentence =
    growthExponent === undefined
      ? "Straight lines are power laws; slope 1 is proportional cost."
      : `The cost grows as vertices to the power of ${formatDigits(growthExponent, 3)} (dashed); 1 is proportional.`;
  const drawn = drawPlot(`${title} ${sentence}`, {
    ...seriesScales(seriesStyles(ids)),
    height: 480,
    x: logScale("Vertices", x),
    y: logScale(
      "CPU time [µs per step]",
      logDomain(
        points.map((point) => point.y),
        0.1,
      ),
    ),
    marks: [
      frame({ stroke: "#8b949e" }),
      line(fit, { x: "x", y: "y", z: "id", stroke: faint, strokeWidth: 1.5, strokeDasharray: "6 4", clip: true }),
      line(points, { x: "x", y: "y", z: "id", stroke: "id", strokeWidth: 2.5 }),
      dot(points, { x: "x", y: "y", fill: "id", symbol: "id", r: 6, stroke: "white" }),
      directLabels(
        ids.map((id) => ({ id, name: seriesName(id), points: points.filter((point) => point.id === id) })),
        fit,
      ),
      text(fit.length === 0 ? [] : [`dashed: vertices^${formatDigits(growthExponent ?? 1, 3)}`], {
        frameAnchor: "bottom-right",
        dx: -12,
        dy: -12,
        fill: faint,
        fontSize: 14,
      }),
      tip(points, pointer({ x: "x", y: "y", title: tooltip, fontSize: 14 })),
    ],
  });
  return figure(title, sentence, drawn);
}

const tooltip = ({ id, x, y }: Point) => `${seriesName(id)}
${formatDigits(x, 9)} vertices: ${formatDigits(y, 3)} µs per step`;

/** Returns the power law through the geometric mean of each series, a little longer than the series. */
function fitted(points: Point[], exponent: number): Point[] {
  const mean = (values: number[]) => Math.exp(values.reduce((sum, each) => sum + Math.log(each), 0) / values.length);
  return [...new Set(points.map(({ id }) => id))].flatMap((id) => {
    const own = points.filter((point) => point.id === id);
    const xs = own.map((point) => point.x);
    const [x, y] = [mean(xs), mean(own.map((point) => point.y))];
    return [Math.min(...xs) / 1.5, Math.max(...xs) * 1.5].map((at) => ({ id, x: at, y: y * (at / x) ** exponent }));
  });
}
