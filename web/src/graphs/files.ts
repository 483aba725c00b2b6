import { scaleLinear } from "d3-scale";
import type { GraphSpec } from "./catalogue";
import { paperColor } from "./colors";
import { type GraphData, valueRange } from "./window";

/** Returns the data as CSV, one row per time, with all digits. */
export function toCsv(spec: GraphSpec, data: GraphData): string {
  const named = (name: string, unit: string) => quoted(unit === "" ? name : `${name} [${unit}]`);
  const across = spec.abscissa === undefined ? [] : [named(spec.abscissa.name, spec.abscissa.unit)];
  const head = [quoted("time [s]"), ...across, ...spec.curves.map(({ name }) => named(name, spec.unit))];
  const columns = [data.times, ...(data.abscissa === undefined ? [] : [data.abscissa]), ...data.curves];
  const rows = data.times.map((_, i) => columns.map((column) => column[i]).join(","));
  return [head.join(","), ...rows, ""].join("\n");
}

function quoted(words: string): string {
  return /[",\n]/.test(words) ? `"${words.replaceAll('"', '""')}"` : words;
}

const width = 720;
const height = 360;
const [left, right, top, bottom] = [64, 16, 40, 48];

/** Returns the graph as SVG for print. */
export function toSvg(spec: GraphSpec, data: GraphData): string {
  const xs = data.abscissa ?? data.times;
  const x = scaleLinear(data.abscissa === undefined ? [xs[0] ?? 0, xs.at(-1) ?? 1] : valueRange([xs], 0), [
    left,
    width - right,
  ]);
  const y = scaleLinear(valueRange(data.curves, 0), [height - bottom, top]);
  const lines = data.curves.map((values, i) => {
    const points = values.map((value, k) => `${x(xs[k]).toFixed(2)},${y(value).toFixed(2)}`).join(" ");
    return `<polyline points="${points}" fill="none" stroke="${paperColor(i)}" stroke-width="1.5"/>`;
  });
  const xLabel = spec.abscissa === undefined ? "time [s]" : `${spec.abscissa.name} [${spec.abscissa.unit}]`;
  return [
    `<svg xmlns="http://www.w3.org/2000/svg" viewBox="0 0 ${width} ${height}" width="${width}" height="${height}"`,
    ` font-family="sans-serif" font-size="12" fill="#222">`,
    `<rect width="${width}" height="${height}" fill="#fff"/>`,
    text(left, 22, `${spec.title}${spec.unit === "" ? "" : ` [${spec.unit}]`}`, 'font-size="15" font-weight="600"'),
    ...curveKey(spec),
    ...x.ticks(8).map((tick) => gridLine(x(tick), x.tickFormat(8)(tick), true)),
    ...y.ticks(6).map((tick) => gridLine(y(tick), y.tickFormat(6)(tick), false)),
    ...lines,
    text((left + width - right) / 2, height - 12, xLabel, 'text-anchor="middle"'),
    "</svg>\n",
  ].join("\n");
}

/** A grid line with its number. */
function gridLine(at: number, words: string, upright: boolean): string {
  const [x1, y1, x2, y2] = upright ? [at, top, at, height - bottom] : [left, at, width - right, at];
  const line = `<line x1="${x1}" y1="${y1}" x2="${x2}" y2="${y2}" stroke="#ddd"/>`;
  const label = upright
    ? text(at, height - bottom + 18, words, 'text-anchor="middle"')
    : text(left - 8, at + 4, words, 'text-anchor="end"');
  return line + label;
}

/** The legend, if there are several curves. */
function curveKey({ curves }: GraphSpec): string[] {
  if (curves.length < 2) return [];
  let at = width - right;
  return curves
    .map(({ name }, i) => ({ name, color: paperColor(i) }))
    .reverse()
    .map(({ name, color }) => {
      const end = at;
      at -= 7 * name.length + 20;
      return text(end, 22, `● ${name}`, `text-anchor="end" fill="${color}"`);
    });
}

function text(x: number, y: number, words: string, more: string): string {
  return `<text x="${x}" y="${y}" ${more}>${words.replaceAll("&", "&amp;").replaceAll("<", "&lt;")}</text>`;
}
