import type { TimeSeries } from "../state/time_series";
import type { GraphSpec } from "./catalogue";

/** A span of simulated time [s]. */
export interface TimeSpan {
  start: number;
  end: number;
}

/** The data of one graph within a span, in its units. */
export interface GraphData {
  times: number[];
  /** For a loop: the values on the horizontal axis. */
  abscissa: number[] | undefined;
  curves: number[][];
}

/** Returns the data of a graph within a span, in its units. */
export function graphData(spec: GraphSpec, history: TimeSeries, { start, end }: TimeSpan): GraphData {
  // One more point on either side, so that curves extend to the edge.
  const first = Math.max(0, history.indexAt(start) - 1);
  const last = Math.min(history.times.length, history.indexAt(end) + 1);
  const part = ({ key, factor }: { key: string; factor: number }) =>
    (history.series.get(key) ?? []).slice(first, last).map((value) => factor * value);
  return {
    times: history.times.slice(first, last),
    abscissa: spec.abscissa && part(spec.abscissa),
    curves: spec.curves.map(part),
  };
}

/** An axis is fitted again when its values take less than this part of it. */
const smallestPart = 0.35;

/** The range of an axis, between round numbers. It stays until the values leave it or become much smaller. */
export class SteadyRange {
  private shown: [low: number, high: number] | undefined;

  /** Returns a range that has all values and is at least `least` wide. */
  of(values: number[][], least: number): [low: number, high: number] {
    if (values.every((each) => each.length === 0)) return this.shown ?? [-1, 1];
    const [low, high] = valueRange(values, least, 0.03);
    const { shown } = this;
    if (shown !== undefined && low >= shown[0] && high <= shown[1])
      if (high - low >= smallestPart * (shown[1] - shown[0])) return shown;
    this.shown = roundRange(low, high);
    return this.shown;
  }
}

/** Returns the range extended to multiples of a round step, about a tenth of it. */
function roundRange(low: number, high: number): [low: number, high: number] {
  const rough = (high - low) / 10;
  const power = 10 ** Math.floor(Math.log10(rough));
  const step = power * ([1, 2, 5].find((each) => each * power >= rough) ?? 10);
  return [step * Math.floor(low / step), step * Math.ceil(high / step)];
}

/** Returns the range of all values with a margin, at least `least` wide. */
export function valueRange(values: number[][], least: number, margin = 0.08): [low: number, high: number] {
  let [low, high] = [Infinity, -Infinity];
  for (const each of values) {
    for (const value of each) {
      if (value < low) low = value;
      if (value > high) high = value;
    }
  }
  if (low > high) return [-1, 1];
  const room = Math.max(margin * (high - low), (least - (high - low)) / 2);
  return [low - room, high + room];
}
