import { barX, type Markish, ruleX, text, tickX } from "@observablehq/plot";
import type { CostRow, StageRow } from "../gen/phrenic/v1/study_results_pb";
import { drawPlot, ink, isPositive } from "./axes";
import { figure } from "./figure";
import { formatDigits } from "./format";

interface Bar {
  name: string;
  value: number;
  /** Label beside the bar. */
  words: string;
  color: string;
  thesis?: number;
}

const blue = "#00609f";
const pale = "#7fb2d8";
const thesisColor = "#b23a12";

/** Bars of the CPU time per step of each variant, with the values of the thesis if there are any. */
export function variantBars(rows: CostRow[]): HTMLElement {
  const title = "CPU time of a step, by variant.";
  const known = rows.filter(({ cpuUsPerStep }) => isPositive(cpuUsPerStep));
  if (known.length === 0) return figure(title, "No variant was measured.");
  const longest = Math.max(...known.map(({ cpuUsPerStep }) => cpuUsPerStep));
  const bars = known.map((row, i): Bar => {
    const thesis = isPositive(row.thesisStepsPerS) ? 1e6 / row.thesisStepsPerS : undefined;
    const color = i === 0 ? blue : pale;
    return { name: row.variant, value: row.cpuUsPerStep, words: barLabel(row, thesis), color, thesis };
  });
  const spread = Math.max(...known.map((row) => row.spread));
  const sentences = [
    `Medians over the trials, which differ by up to ${formatDigits(100 * spread, 2)} %; percentages are of the full scene.`,
    drawnThesis(bars, longest).length > 0 ? "Vertical strokes are values of the thesis." : "",
  ];
  return figure(title, sentences.filter(Boolean).join(" "), drawBars(title, "CPU time [µs per step]", bars));
}

function barLabel(row: CostRow, thesis: number | undefined): string {
  const share = isPositive(row.share) ? `, ${formatDigits(100 * row.share, 3)} %` : "";
  const own = `${formatDigits(row.cpuUsPerStep, 3)} µs${share}`;
  if (thesis === undefined) return own;
  const ratio = row.timesThesis;
  const pace = ratio === undefined ? "" : `, ${formatDigits(ratio, 3)} × its speed`;
  return `${own} (thesis ${formatDigits(thesis, 3)} µs${pace})`;
}

/** Returns the bars whose thesis value fits into the axis. */
function drawnThesis(bars: Bar[], longest: number): Bar[] {
  return bars.filter(({ thesis }) => thesis !== undefined && thesis <= 2.5 * longest);
}

/** Bars of the time per step of each stage, or undefined without data. */
export function stageBars(rows: StageRow[]): HTMLElement | undefined {
  const known = rows.filter(({ usPerStep }) => isPositive(usPerStep));
  if (known.length === 0) return undefined;
  const bars = [...known]
    .sort((a, b) => b.usPerStep - a.usPerStep)
    .map(({ stage, element, usPerStep, share }): Bar => {
      const name = element === "" ? stage : `${stage}: ${element}`;
      const words = `${formatDigits(usPerStep, 3)} µs, ${formatDigits(100 * share, 3)} %`;
      return { name, value: usPerStep, words, color: pale };
    });
  const title = "Time of a step, by stage.";
  const most = bars.find(({ name }) => !name.startsWith("step"));
  const sentence = `Measured inside the process${most === undefined ? "" : `; the largest part is ${most.name}: ${most.words}`}.`;
  return figure(title, sentence, drawBars(title, "Time [µs per step]", bars));
}

function drawBars(title: string, label: string, bars: Bar[]): HTMLElement | SVGSVGElement {
  const thesis = drawnThesis(bars, Math.max(...bars.map(({ value }) => value)));
  const most = Math.max(...bars.map(({ value }) => value), ...thesis.map((bar) => bar.thesis ?? 0));
  const marginLeft = Math.min(360, 24 + 8.2 * Math.max(...bars.map(({ name }) => name.length)));
  const places = bars.map((bar, i) => ({ ...bar, at: String(i), end: Math.max(bar.value, barEnd(bar, thesis)) }));
  const room = roomFor(Math.max(...places.map(({ words }) => words.length)), marginLeft);
  const marks: Markish[] = [
    ruleX([0], { stroke: ink }),
    barX(places, { x: "value", y: "at", fill: "color", inset: 2 }),
    tickX(
      places.filter((bar) => barEnd(bar, thesis) > 0),
      { x: "thesis", y: "at", stroke: thesisColor, strokeWidth: 4 },
    ),
    text(places, { x: "end", y: "at", text: "words", dx: 9, textAnchor: "start", fill: ink, fontSize: 14 }),
  ];
  return drawPlot(`${title} ${bars.map(({ name, words }) => `${name}: ${words}`).join("; ")}.`, {
    height: 80 + 36 * bars.length,
    marginTop: 12,
    marginLeft,
    x: { label, domain: [0, most * room], grid: true, ticks: 6, tickFormat: (value: number) => formatDigits(value) },
    y: {
      type: "band",
      domain: places.map(({ at }) => at),
      tickFormat: (at: string) => clipped(bars[Number(at)].name),
      tickSize: 0,
      label: null,
    },
    color: { type: "identity" },
    marks,
  });
}

const barEnd = (bar: Bar, thesis: Bar[]) => (thesis.some(({ name }) => name === bar.name) ? (bar.thesis ?? 0) : 0);
const clipped = (name: string) => (name.length > 42 ? `${name.slice(0, 41)}…` : name);

/** Returns the length of the axis relative to the longest bar that leaves room for the labels. */
function roomFor(letters: number, marginLeft: number): number {
  const inner = 1080 - marginLeft - 28;
  return 1 / Math.max(0.35, 1 - (7.6 * letters + 16) / inner);
}
