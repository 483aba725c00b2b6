import { plot, type PlotOptions, type ScaleOptions } from "@observablehq/plot";
import { formatTicks } from "./format";

/** Text colour. */
export const ink = "#1b1f24";
/** Colour of secondary texts and lines. */
export const faint = "#59626d";
/** Width of a plot [px]. */
export const wide = 1080;
/** Width of one of two plots side by side [px]. */
export const half = 530;

/** True for finite numbers above 0, which a logarithmic axis can show. */
export const isPositive = (value: number | undefined): value is number =>
  value !== undefined && Number.isFinite(value) && value > 0;

/** Returns the range of the positive values with a margin on a logarithmic axis; at least half a decade. */
export function logDomain(values: number[], air = 0.06): [number, number] {
  const known = values.filter(isPositive);
  if (known.length === 0) return [0.1, 10];
  const low = Math.log10(Math.min(...known));
  const high = Math.log10(Math.max(...known));
  const more = Math.max(air * (high - low), (0.5 - (high - low)) / 2, 0.06);
  return [10 ** (low - more), 10 ** (high + more)];
}

/** True if `value` is within the span of `values`, or within `decades` of them, and can be drawn in the same plot. */
export function isNear(value: number, values: number[], decades: number): boolean {
  if (!isPositive(value) || values.length === 0) return false;
  const [low, high, at] = [Math.min(...values), Math.max(...values), value].map(Math.log10);
  return Math.max(low - at, at - high) <= Math.max(high - low, decades);
}

/** Returns more ticks per decade for small ranges, and decades only for large ones. */
export function logTicks([low, high]: [number, number]): number[] {
  const first = Math.floor(Math.log10(low));
  const last = Math.ceil(Math.log10(high));
  const span = Math.log10(high / low);
  const factors = span < 0.9 ? [1, 2, 3, 4, 5, 6, 8] : span <= 2.2 ? [1, 2, 5] : [1];
  const stride = Math.max(1, Math.ceil(span / 9));
  const ticks: number[] = [];
  for (let exponent = first; exponent <= last; ++exponent) {
    if (exponent % stride !== 0) continue;
    for (const factor of factors) ticks.push(Number(`${factor}e${exponent}`));
  }
  return ticks.filter((tick) => tick >= low * 0.999 && tick <= high * 1.001);
}

/** Returns a logarithmic scale with label, ticks and grid. */
export function logScale(label: string, domain: [number, number]): ScaleOptions {
  const ticks = logTicks(domain);
  return { type: "log", domain, ticks, tickFormat: formatTicks(ticks), label, grid: true };
}

/** Draws a plot in the common style; `label` describes it for screen readers. */
export function drawPlot(label: string, { x, y, ...options }: PlotOptions): SVGSVGElement | HTMLElement {
  const drawn = plot({
    width: wide,
    height: 560,
    marginLeft: 78,
    marginRight: 28,
    marginTop: 32,
    marginBottom: 58,
    className: "plot",
    style: { fontFamily: "inherit", fontSize: "15px", color: ink, background: "white" },
    x: { labelAnchor: "center", labelArrow: "none", labelOffset: 50, ...x },
    y: { labelArrow: "none", labelOffset: 70, ...y },
    ...options,
  });
  // Plot's own styles are in report.css, since the content security policy may not allow inline styles.
  for (const style of drawn.querySelectorAll("style")) style.remove();
  // The plot has one accessible name, so its parts have none.
  for (const part of drawn.querySelectorAll("[aria-label]")) part.removeAttribute("aria-label");
  drawn.setAttribute("role", "img");
  drawn.setAttribute("aria-label", label);
  return drawn;
}

/** Returns the colour and symbol scales of the series. */
export function seriesScales(styles: Map<string, { color: string; symbol: unknown }>): PlotOptions {
  const domain = [...styles.keys()];
  const all = [...styles.values()];
  return {
    color: { type: "categorical", domain, range: all.map(({ color }) => color) },
    symbol: { domain, range: all.map(({ symbol }) => symbol) } as ScaleOptions,
  };
}
