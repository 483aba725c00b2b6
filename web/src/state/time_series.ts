/** Values over the last `span` seconds of simulated time. */
export class TimeSeries {
  readonly times: number[] = [];
  readonly series = new Map<string, number[]>();

  private provisional = false;

  constructor(readonly span: number) {}

  /**
   * Adds values at `time` [s]. Starts again if time goes back or the names change. `provisional` values stay until the
   * next ones are added.
   */
  add(time: number, values: [name: string, value: number][], provisional = false): void {
    if (this.provisional) this.removeLast();
    this.provisional = false;
    const last = this.times.at(-1);
    if (last !== undefined && time === last) return;
    const known = [...this.series.keys()];
    const same = values.length === known.length && values.every(([name], i) => name === known[i]);
    if (!same || (last !== undefined && time < last)) this.restart(values.map(([name]) => name));
    this.provisional = provisional;
    this.times.push(time);
    for (const [name, value] of values) this.series.get(name)?.push(value);
    if (this.times[0] < time - this.span) this.discard(this.indexAt(time - this.span));
  }

  /** Returns the first index with a time of `time` [s] or later. */
  indexAt(time: number): number {
    let [low, high] = [0, this.times.length];
    while (low < high) {
      const middle = (low + high) >> 1;
      if (this.times[middle] < time) low = middle + 1;
      else high = middle;
    }
    return low;
  }

  /** Removes all values and names. */
  clear(): void {
    this.provisional = false;
    this.restart([]);
  }

  private removeLast(): void {
    this.times.pop();
    for (const each of this.series.values()) each.pop();
  }

  private restart(names: string[]): void {
    this.times.length = 0;
    this.series.clear();
    for (const name of names) this.series.set(name, []);
  }

  private discard(count: number): void {
    this.times.splice(0, count);
    for (const values of this.series.values()) values.splice(0, count);
  }
}

/** Returns a value at a time within a series, interpolated linearly. */
export function valueAt(history: TimeSeries, key: string, time: number): number {
  const { times } = history;
  const values = history.series.get(key) ?? [];
  const next = history.indexAt(time);
  if (next <= 0) return values[0];
  if (next >= times.length) return values[values.length - 1];
  const part = (time - times[next - 1]) / (times[next] - times[next - 1]);
  return values[next - 1] + part * (values[next] - values[next - 1]);
}
