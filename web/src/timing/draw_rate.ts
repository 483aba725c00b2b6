/** Mean interval after a drawing above which a machine counts as slow [ms]. */
const slowInterval = 42;
/** Weight of one interval in the moving average. */
const smoothing = 0.1;
const maxInterval = 200;

/** Measures whether the machine draws fast enough for interpolated frames; a slow one draws only received frames. */
export class DrawRate {
  private average = 1000 / 60;
  private last: number | undefined;

  /** Records an animation frame at `now` [ms]; `drew` tells whether the previous one was drawn. */
  recordFrame(now: number, drew: boolean): void {
    if (drew && this.last !== undefined)
      this.average += smoothing * (Math.min(now - this.last, maxInterval) - this.average);
    this.last = now;
  }

  /** True if drawings take less than 42 ms on average. */
  get isFast(): boolean {
    return this.average < slowInterval;
  }
}
