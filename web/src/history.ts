/** Values over simulated time, the last `span` seconds of them: what a strip chart shows. */
export class History {
  readonly times: number[] = [];
  readonly series = new Map<string, number[]>();

  constructor(readonly span: number) {}

  /** Adds the values at `time` [s]. Time that goes back, or other names, start afresh. */
  add(time: number, values: [name: string, value: number][]): void {
    const last = this.times.at(-1);
    if (last !== undefined && time === last) return;
    const known = [...this.series.keys()];
    const same = values.length === known.length && values.every(([name], i) => name === known[i]);
    if (!same || (last !== undefined && time < last)) this.restart(values.map(([name]) => name));
    this.times.push(time);
    for (const [name, value] of values) this.series.get(name)?.push(value);
    while (this.times[0] < time - this.span) this.drop();
  }

  /** The least and greatest of all values; 0 to 0 where there are none. */
  range(): [low: number, high: number] {
    const all = [...this.series.values()].flat();
    return all.length === 0 ? [0, 0] : [Math.min(...all), Math.max(...all)];
  }

  private restart(names: string[]): void {
    this.times.length = 0;
    this.series.clear();
    for (const name of names) this.series.set(name, []);
  }

  private drop(): void {
    this.times.shift();
    for (const values of this.series.values()) values.shift();
  }
}
