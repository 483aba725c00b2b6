import { dot, frame, line, pointer, ruleX, text, tip } from "@observablehq/plot";
import type { StreamingRow, StreamingTable } from "../gen/phrenic/v1/study_results_pb";
import { drawPlot, faint, ink, isNear, isPositive, logDomain, logScale, seriesScales } from "./axes";
import { directLabels } from "./direct_labels";
import { figure } from "./figure";
import { formatDigits } from "./format";
import { seriesName, seriesStyles } from "./names";

interface Point {
  id: string;
  x: number;
  y: number;
  row: StreamingRow;
}

/** Bandwidth of a slow line [Mbit/s]. */
const thin = 4;

/** Plots the largest error against bandwidth; lower left is better. */
export function bandwidth({ rows }: StreamingTable): HTMLElement {
  const title = "Largest error against bandwidth.";
  const points = rows.flatMap((row): Point[] =>
    isPositive(row.errorMaxMm) && isPositive(row.mbitPerSecond)
      ? [{ id: row.codec, x: row.mbitPerSecond, y: row.errorMaxMm, row }]
      : [],
  );
  if (points.length === 0) return figure(title, "No codec has an error to show.");
  const [xs, ys] = [points.map(({ x }) => x), points.map(({ y }) => y)];
  const thinShown = isNear(thin, xs, 1.5);
  const ids = [...new Set(points.map(({ id }) => id))];
  const sentence = captionOf(rows);
  const drawn = drawPlot(`${title} ${sentence}`, {
    ...seriesScales(seriesStyles(ids)),
    height: 560,
    marginTop: 44,
    x: logScale("Mbit/s at 30 frames per second", logDomain(thinShown ? [...xs, thin] : xs)),
    y: logScale("Largest error [mm]", logDomain(ys)),
    marks: [
      frame({ stroke: "#8b949e" }),
      ...(thinShown ? thinLine() : []),
      line(points, { x: "x", y: "y", z: "id", stroke: "id", strokeWidth: 2.5 }),
      dot(points, { x: "x", y: "y", fill: "id", symbol: "id", r: 6, stroke: "white", strokeWidth: 1 }),
      dot(
        points.filter(({ row }) => row.pareto),
        { x: "x", y: "y", r: 10, stroke: ink, strokeWidth: 1.8 },
      ),
      directLabels(ids.map((id) => ({ id, name: seriesName(id), points: points.filter((point) => point.id === id) }))),
      tip(points, pointer({ x: "x", y: "y", title: tooltip, fontSize: 14 })),
    ],
  });
  return figure(title, sentence, drawn);
}

function thinLine() {
  return [
    ruleX([thin], { stroke: faint, strokeWidth: 1.5, strokeDasharray: "7 4" }),
    text(["a connection of 4 Mbit/s"], { x: [thin], frameAnchor: "top", dy: -11, fill: ink, fontSize: 14 }),
  ];
}

function captionOf(rows: StreamingRow[]): string {
  const raw = rows.find(({ codec }) => codec === "raw");
  const exact = raw === undefined ? "" : ` Raw frames are exact and take ${formatDigits(raw.mbitPerSecond, 3)} Mbit/s.`;
  return `Lower is more accurate, further left needs less bandwidth; each dot is one error bound, rings mark the Pareto front.${exact}`;
}

function tooltip({ row }: Point): string {
  return `${seriesName(row.codec)} within ${formatDigits(row.boundMm ?? 0, 3)} mm
largest error ${formatDigits(row.errorMaxMm, 3)} mm, RMS ${formatDigits(row.errorRmsMm, 3)} mm
${formatDigits(row.bytesPerFrame, 6)} bytes per frame, ${formatDigits(row.mbitPerSecond, 3)} Mbit/s
encode ${formatDigits(row.encodeUs, 3)} µs, decode ${formatDigits(row.decodeUs, 3)} µs`;
}
