/** Beats after a drawing that are further apart than this are a weak machine's [ms]. */
const slowInterval = 42;
/** What one beat counts for. */
const smoothing = 0.1;
const maxInterval = 200;

/** Whether the machine draws fast enough for pictures between frames: a weak one draws only those that came. */
export class DrawRate {
  private average = 1000 / 60;
  private last: number | undefined;

  /** Takes note of a beat at `now` [ms] if the one before it drew. */
  recordFrame(now: number, drew: boolean): void {
    if (drew && this.last !== undefined)
      this.average += smoothing * (Math.min(now - this.last, maxInterval) - this.average);
    this.last = now;
  }

  get isFast(): boolean {
    return this.average < slowInterval;
  }
}
