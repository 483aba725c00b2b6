import type { DomeHeights, SniffResult } from "./sniff_test";
import { svg } from "./svg";
import { t } from "../language/translate";

/** Size of the plot, and the room of its axes [CSS pixels]. */
const [width, height, axis, foot] = [288, 132, 34, 18];
const span = 8;

/** Colours of the domes, as in the graphs: right and left. */
export const domeColors = { right: "#ff9b8a", left: "#7cc7ff" };

/**
 * Returns a plot of both domes' heights above those before the sniff over the last seconds; the sniff has a grey
 * ground.
 */
export function sniffPlot(heights: DomeHeights[], result: SniffResult | undefined): SVGSVGElement {
  const plot = svg("svg", { viewBox: `0 0 ${width} ${height}`, class: "sniff-plot", "aria-hidden": "true" });
  const end = Math.max(span, heights.at(-1)?.time ?? 0);
  const shown = heights.filter(({ time }) => time >= end - span);
  if (shown.length < 2) return plot;
  const zero = result?.before ?? shown[0];
  const mm = (side: "right" | "left") => shown.map((each) => 1000 * (each[side] - zero[side]));
  const [right, left] = [mm("right"), mm("left")];
  const [low, high] = [Math.min(-10, ...right, ...left) - 3, Math.max(5, ...right, ...left) + 3];
  const x = (time: number) => axis + ((time - end + span) / span) * (width - axis);
  const y = (value: number) => ((high - value) / (high - low)) * (height - foot);
  const sniff = (time: number) => svg("rect", { class: "sniff-time", x: x(time), y: 0, width: x(end) - x(end - 0.6), height: height - foot }); // prettier-ignore
  if (result !== undefined && result.onset > end - span) plot.append(sniff(result.onset));
  for (const tick of ticks(low, high)) {
    plot.append(svg("line", { class: tick === 0 ? "zero" : "grid", x1: axis, x2: width, y1: y(tick), y2: y(tick) }));
    plot.append(svg("text", { x: axis - 5, y: y(tick) + 4, "text-anchor": "end" }, String(tick)));
  }
  plot.append(svg("text", { x: width, y: height - 4, "text-anchor": "end" }, t("height [mm], last {0} s", span))); // prettier-ignore
  for (const [values, color] of [
    [right, domeColors.right],
    [left, domeColors.left],
  ] as const) {
    // prettier-ignore
    const points = values.map((value, i) => `${x(shown[i].time).toFixed(1)},${y(value).toFixed(1)}`).join(" ");
    plot.append(svg("polyline", { points, stroke: color, fill: "none", "stroke-width": 2 }));
  }
  return plot;
}

function ticks(low: number, high: number): number[] {
  const step = high - low > 60 ? 20 : 10;
  const first = Math.ceil(low / step) * step;
  return Array.from({ length: Math.floor((high - first) / step) + 1 }, (_, i) => first + i * step || 0);
}
