import { FrameDecoder } from "../decoders/frame_decoder";
import type { AckFramesResponse, Frame, GetBasisResponse } from "../gen/phrenic/v1/frames_pb";
import type { Body, FrameArrays } from "../geometry/bodies";
import { DrawRate } from "../timing/draw_rate";
import { FrameHistory } from "./frame_history";
import { interpolate } from "./interpolation";
import { PlayoutBuffer } from "./playout";

/** How frames arrive. */
export interface FrameRate {
  framesPerSecond: number;
  /** How old the newest frame was when it came [ms], by the server's clock; undefined until that is known. */
  age: number | undefined;
  /** How much later than it came it is shown, so that the picture moves evenly [ms]. */
  delay: number;
  /** How far a vertex may be from its own [mm]. */
  errorBound: number;
}

/** Measurements of the server's clock that are kept: the quickest of them counts. */
const maxMeasurements = 30;

/** How far behind a picture may be to be waited for [simulated s], and how long ago its last frame [ms]. */
export const maxWait = 2;
const maxSilence = 2000;

/** A frame, decoded when somebody draws it. */
interface BufferedFrame {
  frame: Frame;
  arrays: FrameArrays | undefined;
}

/** What the picture shows: a frame, or a moment between two [s]. */
export interface DisplayedFrame {
  time: number;
  arrays: FrameArrays;
}

/** The newest frame, the moment that the picture shows, and the rate over the last second. */
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

  /** Both show one moment from now on: frames of one may come later than those of the other. */
  synchroniseWith(other: FrameBuffer): void {
    this.partner = other;
    other.partner = this;
  }

  /** Forgets everything: another scene, or another server. */
  start(bodies: Body[]): void {
    this.newest = this.displayedFrame = this.replayedEntry = undefined;
    this.history.clear();
    this.playout.clear();
    this.decoder = new FrameDecoder(bodies);
    this.arrivals = [];
    this.clock = [];
  }

  receive(frame: Frame, now: number): void {
    const before = this.newest?.frame;
    this.newest = { frame, arrays: undefined };
    this.history.add(frame);
    // Another run of the session does not go on from the one before.
    if (before !== undefined && frame.time < before.time) this.playout.clear();
    this.playout.receive(this.newest, milliseconds(frame.unixNanos), now);
    this.arrived = now;
    this.arrivals.push(now);
    this.dropOldArrivals(now);
  }

  /** Frames that are put together from these shapes may come from now on. */
  addBasis(basis: GetBasisResponse): void {
    this.decoder.addBasis(basis);
  }

  /** An acknowledgement, sent and answered at these times [ms], tells the server's clock half way between. */
  acknowledged({ unixNanos }: AckFramesResponse, sent: number, answered: number): void {
    const offset = milliseconds(unixNanos) - (sent + answered) / 2;
    this.clock.push({ offset, tripTime: answered - sent });
    if (this.clock.length > maxMeasurements) this.clock.shift();
  }

  get frame(): Frame | undefined {
    return this.newest?.frame;
  }

  /** The frame of the present that is shown at `now` [ms]: the newest, or what the picture beside has come to. */
  liveFrame(now: number): Frame | undefined {
    const [newest, there] = [this.frame, this.partner?.recentFrame(now)];
    if (newest === undefined || there === undefined) return newest;
    const ahead = newest.time - there.time;
    if (ahead <= 0 || ahead > maxWait) return newest;
    return this.history.nearest(Math.max(there.time, this.displayedFrame?.time ?? 0));
  }

  /** The newest frame, where some have come of late. */
  private recentFrame(now: number): Frame | undefined {
    return now - this.arrived < maxSilence ? this.frame : undefined;
  }

  /** From the oldest frame that can be looked back to, to the newest [s]. */
  get span(): { start: number; end: number } {
    return this.history.span;
  }

  /** The earlier frame that the picture shows; nothing where it shows the present. */
  get replayedFrame(): Frame | undefined {
    return this.history.replayed;
  }

  /** Shows the moment `time` [s] again from now on, or the present. */
  replayAt(time: number | undefined): void {
    this.history.replayAt(time);
  }

  /** The time of the frame before, or after, the one that is shown; nothing where that is the present. */
  adjacentTime(by: -1 | 1): number | undefined {
    return this.history.adjacentTime(by);
  }

  /** Of the newest frame. */
  get arrays(): FrameArrays | undefined {
    return this.newest === undefined ? undefined : this.decode(this.newest);
  }

  /** What `advance` came to last. */
  get displayed(): DisplayedFrame | undefined {
    return this.displayedFrame;
  }

  /**
   * Goes on to the moment that is due at `now` [ms]; whether the picture changes by it. Where a person asked for calm, or
   * the machine is slow, that is the newest frame.
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
    const present = this.liveFrame(now);
    if (present !== undefined && present.time < time) return this.replayed(present);
    return { time, arrays: interpolate(this.decode(before), this.decode(after), part) };
  }

  /** A frame that is looked at again is decoded again. */
  private replayed(frame: Frame): DisplayedFrame {
    if (this.replayedEntry?.frame !== frame) this.replayedEntry = { frame, arrays: undefined };
    return { time: frame.time, arrays: this.decode(this.replayedEntry) };
  }

  private decode(taken: BufferedFrame): FrameArrays {
    return (taken.arrays ??= this.decoder.decode(taken.frame));
  }

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
