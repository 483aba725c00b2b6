import { dot, frame, line, type Markish, pointer, text, tip } from "@observablehq/plot";
import type { ErrorTable } from "../gen/phrenic/v1/study_results_pb";
import { drawPlot, half, ink, isPositive, logDomain, logScale, seriesScales } from "./axes";
import { directLabels } from "./direct_labels";
import { figure } from "./figure";
import { formatDigits } from "./format";
import { sentenceCase, type SeriesStyle } from "./names";

interface Point {
  id: string;
  x: number;
  y: number;
}

const styles: [string, SeriesStyle["symbol"]][] = [
  ["#00609f", "circle"],
  ["#b23a12", "square"],
  ["#00704c", "diamond"],
  ["#6f3fa0", "triangle"],
];

/** Plots the length error of rigid links over time for each projection method; undefined without data. */
export function residuals(table: ErrorTable): HTMLElement | undefined {
  const points = table.residuals.flatMap(({ projection, timeS, residualMm }) =>
    isPositive(residualMm) ? [{ id: projection, x: timeS, y: residualMm }] : [],
  );
  if (points.length === 0) return undefined;
  const worst = Math.max(...points.map(({ y }) => y));
  const meaning = worst < 1e-9 ? ", which is round-off" : "";
  const sentence = `Rigid links differ from their length by at most ${formatDigits(worst, 2)} mm${meaning}.`;
  return overTime("Residual of rigid links.", "Residual [mm]", sentence, points);
}

/** Plots the position error that each projection method causes; undefined without data. */
export function positionErrors(table: ErrorTable): HTMLElement | undefined {
  const points = table.residuals.flatMap(({ projection, timeS, errorRmsMm }) =>
    isPositive(errorRmsMm) ? [{ id: projection, x: timeS, y: errorRmsMm }] : [],
  );
  if (points.length === 0) return undefined;
  const ids = [...new Set(points.map(({ id }) => id))];
  const last = ids.map((id) => ({ id, y: points.findLast((point) => point.id === id)!.y }));
  const words = last.map(({ id, y }) => `${formatDigits(y, 2)} mm (${id})`).join(", ");
  const sentence = `The projection method affects the motion: at the end the RMS error is ${words}.`;
  return overTime("Error by projection.", "RMS error of positions [mm]", sentence, points);
}

function overTime(title: string, label: string, sentence: string, points: Point[]): HTMLElement {
  const ids = [...new Set(points.map(({ id }) => id))];
  const seriesStyle = new Map(ids.map((id, i) => [id, { color: styles[i % 4][0], symbol: styles[i % 4][1] }]));
  const lines = ids.map((id) => ({ id, name: sentenceCase(id), points: points.filter((point) => point.id === id) }));
  const values = points.map(({ y }) => y);
  const drawn = drawPlot(`${title} ${sentence}`, {
    ...seriesScales(seriesStyle),
    width: half,
    height: 400,
    marginLeft: 74,
    x: { label: "Time [s]", domain: [0, 1.04 * Math.max(...points.map(({ x }) => x))], ticks: 6, grid: true },
    y: logScale(label, logDomain(values, 0.15)),
    marks: [
      frame({ stroke: "#8b949e" }),
      // Later curves are thinner, so that coinciding curves remain visible.
      ...lines.flatMap(({ id, points: own }, i) => [
        line(own, { x: "x", y: "y", stroke: seriesStyle.get(id)!.color, strokeWidth: Math.max(2, 5 - 3 * i) }),
        dot(own, { x: "x", y: "y", fill: () => id, symbol: () => id, r: Math.max(3, 7 - 3 * i), stroke: "white" }),
      ]),
      tip(points, pointer({ x: "x", y: "y", title: tooltip, fontSize: 14 })),
      directLabels(lines),
    ],
  });
  return figure(title, sentence, drawn);
}

const tooltip = ({ id, x, y }: Point) => `${sentenceCase(id)}: ${formatDigits(y, 3)} mm at ${formatDigits(x, 3)} s`;

/** Plots the probes' error against the element size; undefined without data. */
export function resolutions(table: ErrorTable): HTMLElement | undefined {
  const rows = table.resolutions.flatMap(({ resolutionMm, errorProbeMm, vertices }) =>
    isPositive(errorProbeMm) && isPositive(resolutionMm)
      ? [{ x: resolutionMm, y: errorProbeMm, words: `${formatDigits(Number(vertices), 9)} vertices` }]
      : [],
  );
  if (rows.length === 0) return undefined;
  const x = logDomain(
    rows.map((row) => row.x),
    0.25,
  );
  const finest = Math.min(...table.resolutions.map(({ resolutionMm }) => resolutionMm));
  const title = "Error against resolution.";
  const sentence = `The probes' displacements against those at the finest resolution, ${formatDigits(finest)} mm.`;
  const marks: Markish[] = [
    frame({ stroke: "#8b949e" }),
    line(rows, { x: "x", y: "y", stroke: styles[0][0], strokeWidth: 2.5 }),
    dot(rows, { x: "x", y: "y", fill: styles[0][0], r: 6 }),
    text(rows, { x: "x", y: "y", text: "words", dy: -18, fill: ink, fontSize: 13, stroke: "white", strokeWidth: 4 }),
  ];
  const y = logScale(
    "Error of the probes [mm]",
    logDomain(
      rows.map((row) => row.y),
      0.2,
    ),
  );
  const size = { width: half, height: 400, marginLeft: 74 };
  const drawn = drawPlot(`${title} ${sentence}`, { ...size, x: logScale("Edge length [mm]", x), y, marks });
  return figure(title, sentence, drawn);
}
