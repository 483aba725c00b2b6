import { FrameDecoder } from "../decoders/frame_decoder";
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

/** A frame that is decoded when it is drawn first. */
interface BufferedFrame {
  frame: Frame;
  arrays: FrameArrays | undefined;
}

/** What the viewer displays: a frame, or an interpolation between two, at `time` [s]. */
export interface DisplayedFrame {
  time: number;
  arrays: FrameArrays;
}

/** Holds the received frames: the newest one, those of the last seconds, and the one that is displayed. */
export class FrameBuffer {
  private newest: BufferedFrame | undefined;
  private readonly history = new FrameHistory();
  private replayedEntry: BufferedFrame | undefined;
  private displayedFrame: DisplayedFrame | undefined;
  private playout = new PlayoutBuffer<BufferedFrame>();
  private readonly drawRate = new DrawRate();
  private changed = false;
  private smooth = false;
  private decoder = new FrameDecoder([]);
  private arrived = -Infinity;
  private arrivals: number[] = [];
  private clock: { offset: number; tripTime: number }[] = [];
  private partner: FrameBuffer | undefined;

  /** Both buffers display the same simulated time from now on, although the frames of one may arrive later. */
  synchroniseWith(other: FrameBuffer): void {
    this.partner = other;
    other.partner = this;
  }

  /** Clears everything, for another scene or server. */
  start(bodies: Body[]): void {
    this.newest = this.displayedFrame = this.replayedEntry = undefined;
    this.history.clear();
    this.playout.clear();
    this.decoder = new FrameDecoder(bodies);
    this.arrivals = [];
    this.clock = [];
  }

  /** Adds a frame that arrived at `now` [ms]. */
  receive(frame: Frame, now: number): void {
    const before = this.newest?.frame;
    this.newest = { frame, arrays: undefined };
    this.history.add(frame);
    // A restarted run does not continue the previous one.
    if (before !== undefined && frame.time < before.time) this.playout.clear();
    this.playout.receive(this.newest, milliseconds(frame.unixNanos), now);
    this.arrived = now;
    this.arrivals.push(now);
    this.dropOldArrivals(now);
  }

  /** Adds a basis that later frames refer to. */
  addBasis(basis: GetBasisResponse): void {
    this.decoder.addBasis(basis);
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

  /** Arrays of the newest frame. */
  get arrays(): FrameArrays | undefined {
    return this.newest === undefined ? undefined : this.decode(this.newest);
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
    this.displayedFrame = due;
    return this.changed;
  }

  private frameDue(now: number): DisplayedFrame | undefined {
    const between = this.playout.at(now);
    if (this.newest === undefined || between === undefined) return undefined;
    const { replayed } = this.history;
    if (replayed !== undefined) return this.replayed(replayed);
    const { before, after, part } = this.smooth ? between : { before: this.newest, after: this.newest, part: 0 };
    const time = before.frame.time + part * (after.frame.time - before.frame.time);
    const live = this.liveFrame(now);
    if (live !== undefined && live.time < time) return this.replayed(live);
    return { time, arrays: interpolate(this.decode(before), this.decode(after), part) };
  }

  /** Decodes a replayed frame again and caches it. */
  private replayed(frame: Frame): DisplayedFrame {
    if (this.replayedEntry?.frame !== frame) this.replayedEntry = { frame, arrays: undefined };
    return { time: frame.time, arrays: this.decode(this.replayedEntry) };
  }

  private decode(entry: BufferedFrame): FrameArrays {
    return (entry.arrays ??= this.decoder.decode(entry.frame));
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

function milliseconds(unixNanos: bigint): number {
  return Number(unixNanos / 1000n) / 1000;
}
