import type { TimeSeries } from "../state/time_series";

/** What one breath moves: from its smallest to its largest lung volume. */
export interface BreathMotion {
  /** Difference of the lung volumes [m^3]. */
  tidalVolume: number;
  /** Change of the height of each dome [m]; positive if it rises while the lungs fill. */
  domes: { name: string; change: number }[];
}

/** Where the values of a BreathMotion are in a time series. */
export interface MotionKeys {
  volume: string;
  domes: { key: string; name: string }[];
}

/** Largest gap between two values, as a part of the breath: it hides at most a tenth of the motion of a cosine. */
const largestGap = 1 / 5;

/**
 * Returns the motion of the last `period` seconds of `history`; undefined if the history since `since` [s] is shorter
 * than that or has gaps.
 */
export function breathMotion(
  history: TimeSeries,
  keys: MotionKeys,
  period: number,
  since: number,
): BreathMotion | undefined {
  const end = history.times.at(-1);
  if (end === undefined || end - period < Math.max(since, history.times[0])) return undefined;
  const volumes = history.series.get(keys.volume);
  const first = history.indexAt(end - period);
  if (volumes === undefined || hasGap(history.times.slice(Math.max(0, first - 1)), largestGap * period))
    return undefined;
  let [emptiest, fullest] = [first, first];
  for (let i = emptiest; i < volumes.length; i++) {
    if (volumes[i] < volumes[emptiest]) emptiest = i;
    if (volumes[i] > volumes[fullest]) fullest = i;
  }
  const domes = keys.domes.map(({ key, name }) => {
    const heights = history.series.get(key) ?? [];
    return { name, change: (heights[fullest] ?? NaN) - (heights[emptiest] ?? NaN) };
  });
  return { tidalVolume: volumes[fullest] - volumes[emptiest], domes };
}

function hasGap(times: number[], largest: number): boolean {
  return times.some((time, i) => i > 0 && time - times[i - 1] > largest);
}
