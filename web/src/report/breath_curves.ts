import { frame, line } from "@observablehq/plot";
import type { PhysiologyCurve } from "../gen/phrenic/v1/physiology_pb";
import { drawPlot, half } from "./axes";
import { directLabels } from "./direct_labels";
import { figure, sideBySide } from "./figure";
import { seriesStyles } from "./names";

interface Point {
  id: string;
  x: number;
  y: number;
}

/** Plots the curves of one breath, those of one unit together. */
export function breathCurves(curves: PhysiologyCurve[]): HTMLElement[] {
  const units = [...new Set(curves.map(({ unit }) => unit))];
  const figures = units.map((unit) =>
    curvesOf(
      unit,
      curves.filter((curve) => curve.unit === unit),
    ),
  );
  return [sideBySide(...figures.slice(0, 2)), sideBySide(...figures.slice(2))];
}

function curvesOf(unit: string, curves: PhysiologyCurve[]): HTMLElement {
  const series = curves.map(({ what, timeS, values }) => ({
    id: what,
    name: what,
    points: timeS.map((x, i): Point => ({ id: what, x, y: values[i] })),
  }));
  const points = series.flatMap((each) => each.points);
  const styles = seriesStyles(series.map(({ id }) => id));
  const title = `${series.map(({ name }) => name).join(", ")}.`;
  const drawn = drawPlot(title, {
    width: half,
    height: 380,
    color: { type: "categorical", domain: [...styles.keys()], range: [...styles.values()].map(({ color }) => color) },
    x: { label: "Time [s]", grid: true },
    y: { label: `[${unit}]`, grid: true },
    marks: [
      frame({ stroke: "#8b949e" }),
      line(points, { x: "x", y: "y", z: "id", stroke: "id", strokeWidth: 2.5 }),
      directLabels(series),
    ],
  });
  return figure(title.charAt(0).toUpperCase() + title.slice(1), `In ${unit}, from the beginning of the breath.`, drawn);
}
