import { decodeFrame, type FrameArrays } from "./codec";
import type { Frame } from "./gen/phrenic/v1/frames_pb";

/** How frames arrive. */
export interface FrameRate {
  framesPerSecond: number;
  /** How much later than the quickest one the frames of the last second came [ms]: clocks need not agree. */
  delay: number;
}

/** The newest frame, decoded only when somebody draws it, and the rate over the last second. */
export class Frames {
  private newest: Frame | undefined;
  private decoded: FrameArrays | undefined;
  private arrivals: { at: number; transit: number }[] = [];
  private quickest = Infinity;

  /** Forgets everything: another scene, or another server. */
  clear(): void {
    this.newest = undefined;
    this.decoded = undefined;
    this.arrivals = [];
    this.quickest = Infinity;
  }

  receive(frame: Frame, now: number): void {
    this.newest = frame;
    this.decoded = undefined;
    const transit = now - Number(frame.unixNanos / 1000n) / 1000;
    this.quickest = Math.min(this.quickest, transit);
    this.arrivals.push({ at: now, transit });
    this.forget(now);
  }

  get frame(): Frame | undefined {
    return this.newest;
  }

  get arrays(): FrameArrays | undefined {
    if (this.newest !== undefined) this.decoded ??= decodeFrame(this.newest);
    return this.decoded;
  }

  rate(now: number): FrameRate {
    this.forget(now);
    const last = this.arrivals.at(-1);
    const delay = last === undefined ? 0 : last.transit - this.quickest;
    return { framesPerSecond: this.arrivals.length, delay };
  }

  private forget(now: number): void {
    while (this.arrivals.length > 0 && this.arrivals[0].at <= now - 1000) this.arrivals.shift();
  }
}
