import { valueAt, type TimeSeries } from "../state/time_series";

/** Number of points of a drawn curve. */
const points = 41;

/** A predicted curve over a span of simulated time: flat at first, changed by drawing. */
export class Prediction {
  readonly values: number[];

  /** `start` and `length` in simulated seconds; `first` is the value at the start. */
  constructor(
    readonly start: number,
    readonly length: number,
    first: number,
  ) {
    this.values = Array<number>(points).fill(first);
  }

  /** Returns the same curve over a span of another length [simulated s]. */
  over(length: number): Prediction {
    const stretched = new Prediction(this.start, length, this.values[0]);
    this.values.forEach((value, i) => (stretched.values[i] = value));
    return stretched;
  }

  /** The end of the span [simulated s]. */
  get end(): number {
    return this.start + this.length;
  }

  /** Returns the time of a point [simulated s]. */
  timeOf(point: number): number {
    return this.start + (point * this.length) / (points - 1);
  }

  /** Returns the point nearest to a part of the span, 0 to 1. */
  pointAt(part: number): number {
    return Math.min(points - 1, Math.max(0, Math.round(part * (points - 1))));
  }

  /** Draws a straight line between two points; the first value of the curve is known and stays. */
  line(from: { point: number; value: number }, to: { point: number; value: number }): void {
    const step = Math.sign(to.point - from.point) || 1;
    for (let i = from.point; i !== to.point + step; i += step) {
      const part = to.point === from.point ? 1 : (i - from.point) / (to.point - from.point);
      if (i > 0) this.values[i] = from.value + part * (to.value - from.value);
    }
  }

  /** Returns the mean distance from a curve that covers the whole span, in its unit. */
  distance(history: TimeSeries, key: string): number {
    const distances = this.values.map((value, i) => Math.abs(value - valueAt(history, key, this.timeOf(i))));
    return distances.reduce((sum, each) => sum + each) / points;
  }
}
