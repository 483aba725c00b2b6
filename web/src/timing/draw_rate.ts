/** Beats after a drawing that are further apart than this are a weak machine's [ms]. */
const slow = 42;
/** What one beat counts for. */
const weight = 0.1;
const longest = 200;

/** Whether the machine draws fast enough for pictures between frames: a weak one draws only those that came. */
export class SteadyBeat {
  private average = 1000 / 60;
  private last: number | undefined;

  /** Takes note of a beat at `now` [ms] if the one before it drew. */
  beat(now: number, drew: boolean): void {
    if (drew && this.last !== undefined) this.average += weight * (Math.min(now - this.last, longest) - this.average);
    this.last = now;
  }

  get fast(): boolean {
    return this.average < slow;
  }
}
