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

/** Returns the range of all values with a margin, at least `least` wide. */
export function valueRange(values: number[][], least: number): [low: number, high: number] {
  let [low, high] = [Infinity, -Infinity];
  for (const each of values) {
    for (const value of each) {
      if (value < low) low = value;
      if (value > high) high = value;
    }
  }
  if (low > high) return [-1, 1];
  const room = Math.max(0.08 * (high - low), (least - (high - low)) / 2);
  return [low - room, high + room];
}
