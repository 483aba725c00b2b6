import type { Decoding } from "../decoders/decoding";
import type { AckFramesResponse, Frame, GetBasisResponse } from "../gen/phrenic/v1/frames_pb";
import type { Body, FrameArrays } from "../geometry/bodies";
import { DrawRate } from "../timing/draw_rate";
import { FrameHistory } from "./frame_history";
import { interpolate } from "./interpolation";
import { PlayoutBuffer } from "./playout";

/** Rate, age and accuracy of the received frames. */
export interface FrameRate {
  framesPerSecond: number;
  /** Age of the newest frame at arrival by the server's clock [ms]; undefined until the clock offset is known. */
  age: number | undefined;
  /** Delay between arrival and display that smooths the motion [ms]. */
  delay: number;
  /** Largest position error of a vertex [mm]. */
  errorBound: number;
}

/** Number of clock offset measurements that are kept; the one with the shortest round trip is used. */
const maxMeasurements = 30;

/**
 * A synchronised partner is not waited for if it is further behind than this [simulated s], or if its last frame is
 * older than this [ms].
 */
export const maxWait = 2;
const maxSilence = 2000;

/** A frame that is being decoded, or was. */
interface BufferedFrame {
  frame: Frame;
  arrays: FrameArrays | undefined;
  /** True from when it is passed to the decoder until that drops it. */
  requested: boolean;
  /** Number of the arrival; undefined for a frame that is decoded again to be replayed. */
  arrival: number | undefined;
}

/** What the viewer displays: a frame, or an interpolation between two, at `time` [s]. */
export interface DisplayedFrame {
  time: number;
  arrays: FrameArrays;
}

/** Holds the received frames: the newest one, those of the last seconds, and the one that is displayed. */
export class FrameBuffer {
  private newest: BufferedFrame | undefined;
  /** The newest frame that is decoded. */
  private newestDecoded: BufferedFrame | undefined;
  private arrivalCount = 0;
  private readonly history = new FrameHistory();
  private replayedEntry: BufferedFrame | undefined;
  /** The last replayed frame that is decoded, which is displayed until the next one is. */
  private replayedDecoded: BufferedFrame | undefined;
  private displayedFrame: DisplayedFrame | undefined;
  private playout = new PlayoutBuffer<BufferedFrame>();
  private readonly drawRate = new DrawRate();
  private changed = false;
  private smooth = false;
  private arrived = -Infinity;
  private arrivals: number[] = [];
  private clock: { offset: number; tripTime: number }[] = [];
  private partner: FrameBuffer | undefined;

  /** `failed` gets what is wrong with a frame that cannot be decoded; the frame before it stays. */
  constructor(
    private readonly decoding: Decoding,
    private readonly failed: (error: RangeError) => void,
  ) {}

  /** Both buffers display the same simulated time from now on, although the frames of one may arrive later. */
  synchroniseWith(other: FrameBuffer): void {
    this.partner = other;
    other.partner = this;
  }

  /** Clears everything, for another scene or server. */
  start(bodies: Body[]): void {
    this.newest = this.newestDecoded = this.displayedFrame = undefined;
    this.replayedEntry = this.replayedDecoded = undefined;
    this.history.clear();
    this.playout.clear();
    this.decoding.start(bodies);
    this.arrivals = [];
    this.clock = [];
  }

  /** Adds a frame that arrived at `now` [ms]. */
  receive(frame: Frame, now: number): void {
    const before = this.newest?.frame;
    this.newest = { frame, arrays: undefined, requested: false, arrival: this.arrivalCount++ };
    this.history.add(frame);
    // A restarted run does not continue the previous one.
    if (before !== undefined && frame.time < before.time) this.playout.clear();
    this.playout.receive(this.newest, milliseconds(frame.unixNanos), now);
    this.decode(this.newest);
    this.arrived = now;
    this.arrivals.push(now);
    this.dropOldArrivals(now);
  }

  /** Adds a basis that later frames refer to. */
  addBasis(basis: GetBasisResponse): void {
    this.decoding.addBasis(basis);
  }

  /** Estimates the offset of the server's clock from an acknowledgement and the times of request and response [ms]. */
  acknowledged({ unixNanos }: AckFramesResponse, sent: number, answered: number): void {
    const offset = milliseconds(unixNanos) - (sent + answered) / 2;
    this.clock.push({ offset, tripTime: answered - sent });
    if (this.clock.length > maxMeasurements) this.clock.shift();
  }

  /** The newest frame. */
  get frame(): Frame | undefined {
    return this.newest?.frame;
  }

  /** Returns the live frame to display at `now` [ms]: the newest one, or an earlier one if the partner is behind. */
  liveFrame(now: number): Frame | undefined {
    const [newest, there] = [this.frame, this.partner?.recentFrame(now)];
    if (newest === undefined || there === undefined) return newest;
    const ahead = newest.time - there.time;
    if (ahead <= 0 || ahead > maxWait) return newest;
    return this.history.nearest(Math.max(there.time, this.displayedFrame?.time ?? 0));
  }

  /** Returns the newest frame if frames arrived recently. */
  private recentFrame(now: number): Frame | undefined {
    return now - this.arrived < maxSilence ? this.frame : undefined;
  }

  /** Time range of the frames that can be replayed [s]. */
  get span(): { start: number; end: number } {
    return this.history.span;
  }

  /** The replayed frame; undefined when live. */
  get replayedFrame(): Frame | undefined {
    return this.history.replayed;
  }

  /** Displays an earlier time [s] from now on, or live frames if undefined. */
  replayAt(time: number | undefined): void {
    this.history.replayAt(time);
  }

  /** Returns the time of the frame before or after the displayed one [s]; undefined if that is the live one. */
  adjacentTime(by: -1 | 1): number | undefined {
    return this.history.adjacentTime(by);
  }

  /** Arrays of the newest frame that is decoded. */
  get arrays(): FrameArrays | undefined {
    return this.newestDecoded?.arrays;
  }

  /** The result of the last call of `advance`. */
  get displayed(): DisplayedFrame | undefined {
    return this.displayedFrame;
  }

  /**
   * Advances to the frame that is due at `now` [ms]; returns true if the display changes. Without smoothing, because of
   * reduced motion or a slow machine, this is the newest frame.
   */
  advance(now: number, reducedMotion: boolean): boolean {
    this.drawRate.recordFrame(now, this.changed);
    this.smooth = !reducedMotion && this.drawRate.isFast;
    const due = this.frameDue(now);
    this.changed = due !== undefined && due.arrays !== this.displayedFrame?.arrays;
    if (due !== undefined) this.displayedFrame = due;
    return this.changed;
  }

  /** Returns what is due; undefined before the first frame, and while that which is due is still being decoded. */
  private frameDue(now: number): DisplayedFrame | undefined {
    const between = this.playout.at(now);
    const newest = this.newestDecoded;
    if (newest === undefined || between === undefined) return undefined;
    const { replayed } = this.history;
    if (replayed !== undefined) return this.replayed(replayed);
    const { before, after, part } = this.smooth ? between : { before: newest, after: newest, part: 0 };
    const time = before.frame.time + part * (after.frame.time - before.frame.time);
    const live = this.liveFrame(now);
    if (live !== undefined && live.time < time) return this.replayed(live);
    this.replayedEntry = this.replayedDecoded = undefined;
    const [from, to] = [this.decode(before), this.decode(after)];
    if (from === undefined || to === undefined) return displayOf(newest);
    return { time, arrays: interpolate(from, to, part) };
  }

  /** Decodes a replayed frame again and caches it. */
  private replayed(frame: Frame): DisplayedFrame | undefined {
    if (this.replayedEntry?.frame !== frame)
      this.replayedEntry = { frame, arrays: undefined, requested: false, arrival: undefined };
    this.decode(this.replayedEntry);
    return this.replayedDecoded && displayOf(this.replayedDecoded);
  }

  /** Returns the arrays of a frame; undefined until they are decoded, which this starts. */
  private decode(entry: BufferedFrame): FrameArrays | undefined {
    if (entry.arrays !== undefined || entry.requested) return entry.arrays;
    entry.requested = true;
    this.decoding.decode(entry.frame, (result) => {
      if (result instanceof RangeError) return this.failed(result);
      entry.arrays = result;
      entry.requested = result !== undefined;
      if (result !== undefined) this.keepDecoded(entry);
    });
    return entry.arrays;
  }

  private keepDecoded(entry: BufferedFrame): void {
    if (entry.arrival === undefined) this.replayedDecoded = entry;
    else if (entry.arrival > (this.newestDecoded?.arrival ?? -1)) this.newestDecoded = entry;
  }

  /** Returns rate, age and accuracy over the last second before `now` [ms]. */
  rate(now: number): FrameRate {
    this.dropOldArrivals(now);
    return {
      framesPerSecond: this.arrivals.length,
      age: this.age(),
      delay: this.smooth ? this.playout.delay : 0,
      errorBound: this.frame?.maxErrorMm ?? 0,
    };
  }

  private age(): number | undefined {
    const arrived = this.arrivals.at(-1);
    if (this.newest === undefined || arrived === undefined || this.clock.length === 0) return undefined;
    const best = this.clock.reduce((a, b) => (b.tripTime < a.tripTime ? b : a));
    return arrived + best.offset - milliseconds(this.newest.frame.unixNanos);
  }

  private dropOldArrivals(now: number): void {
    while (this.arrivals.length > 0 && this.arrivals[0] <= now - 1000) this.arrivals.shift();
  }
}

function displayOf({ frame: { time }, arrays }: BufferedFrame): DisplayedFrame | undefined {
  return arrays && { time, arrays };
}

function milliseconds(unixNanos: bigint): number {
  return Number(unixNanos / 1000n) / 1000;
}
