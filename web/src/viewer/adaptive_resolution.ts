/** Beats further apart than this are slow [ms]. */
const slowInterval = 70;
/** Slow beats in a row before the picture gets coarser, and time at rest before it is drawn once in full [ms]. */
const maxSlowFrames = 6;
const restDelay = 400;
const minRatio = 0.5;

/**
 * Pixels drawn for each CSS pixel. A machine that cannot keep up gets fewer of them while things move, so that the page
 * stays alive, and the full number as soon as the picture stands still.
 */
export class AdaptiveResolution {
  private movingRatio: number;
  private currentRatio: number;
  private slowFrames = 0;
  private lastDrawn = -Infinity;
  private lastFrame = -Infinity;

  constructor(private readonly fullRatio: number) {
    this.movingRatio = fullRatio;
    this.currentRatio = fullRatio;
  }

  get ratio(): number {
    return this.currentRatio;
  }

  /** Takes note of a beat at `now` [ms] and whether it draws; true where `ratio` changes with it. */
  recordFrame(now: number, draws: boolean): boolean {
    const steady = draws && this.lastDrawn === this.lastFrame;
    if (steady) this.judge(now - this.lastFrame);
    this.lastFrame = now;
    if (draws) this.lastDrawn = now;
    const wanted =
      !draws && now - this.lastDrawn > restDelay ? this.fullRatio : draws ? this.movingRatio : this.currentRatio;
    const changed = wanted !== this.currentRatio;
    this.currentRatio = wanted;
    return changed;
  }

  private judge(interval: number): void {
    this.slowFrames = interval > slowInterval ? this.slowFrames + 1 : 0;
    if (this.slowFrames < maxSlowFrames) return;
    this.slowFrames = 0;
    this.movingRatio = Math.max(Math.min(minRatio, this.fullRatio), this.movingRatio * 0.7);
  }
}
