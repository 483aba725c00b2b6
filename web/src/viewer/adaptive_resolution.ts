/** Interval above which an animation frame is slow [ms]. */
const slowInterval = 70;
/** Slow frames in a row before the resolution is reduced, and idle time before one drawing in full resolution [ms]. */
const maxSlowFrames = 6;
const restDelay = 400;

/**
 * Device pixels per CSS pixel. A slow machine draws fewer pixels during motion, so that the page stays responsive, and
 * the full number when the scene is at rest.
 */
export class AdaptiveResolution {
  private movingRatio: number;
  private currentRatio: number;
  private slowFrames = 0;
  private lastDrawn = -Infinity;
  private lastFrame = -Infinity;

  /** The full ratios at rest and during motion, and the least one during motion. */
  constructor(
    private readonly fullRatio: number,
    movingRatio = fullRatio,
    private readonly leastRatio = 0.5,
  ) {
    this.movingRatio = movingRatio;
    this.currentRatio = movingRatio;
  }

  /** Current number of device pixels per CSS pixel. */
  get ratio(): number {
    return this.currentRatio;
  }

  /** Records an animation frame at `now` [ms] and whether it is drawn. Returns true if `ratio` changes. */
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
    this.movingRatio = Math.max(Math.min(this.leastRatio, this.fullRatio), this.movingRatio * 0.7);
  }
}

/**
 * Returns the resolution of a machine. Without a graphics card, smoothing edges costs as much as all the rest of a
 * drawing; instead a scene at rest is drawn with twice the pixels. Fewer pixels in motion would save little.
 */
export function resolutionFor(software: boolean): AdaptiveResolution {
  const ratio = Math.min(devicePixelRatio, 2);
  return software ? new AdaptiveResolution(2, ratio, 0.8) : new AdaptiveResolution(ratio);
}
