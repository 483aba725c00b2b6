import { FrameDecoder } from "../decoders/frame_decoder";
import type { AckFramesResponse, Frame, GetBasisResponse } from "../gen/phrenic/v1/frames_pb";
import type { Body, FrameArrays } from "../geometry/bodies";
import { SteadyBeat } from "../timing/draw_rate";
import { Past } from "./frame_history";
import { blend } from "./interpolation";
import { Playout } from "./playout";

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
const mostMeasurements = 30;

/** How far behind a picture may be to be waited for [simulated s], and how long ago its last frame [ms]. */
export const longestWait = 2;
const longestQuiet = 2000;

/** A frame, decoded when somebody draws it. */
interface Taken {
  frame: Frame;
  arrays: FrameArrays | undefined;
}

/** What the picture shows: a frame, or a moment between two [s]. */
export interface Moment {
  time: number;
  arrays: FrameArrays;
}

/** The newest frame, the moment that the picture shows, and the rate over the last second. */
export class Frames {
  private newest: Taken | undefined;
  private readonly past = new Past();
  private again: Taken | undefined;
  private shown: Moment | undefined;
  private playout = new Playout<Taken>();
  private readonly steady = new SteadyBeat();
  private changed = false;
  private smooth = false;
  private decoder = new FrameDecoder([]);
  private arrived = -Infinity;
  private arrivals: number[] = [];
  private clock: { offset: number; tripTime: number }[] = [];
  private companion: Frames | undefined;

  /** Both show one moment from now on: frames of one may come later than those of the other. */
  goInStepWith(other: Frames): void {
    this.companion = other;
    other.companion = this;
  }

  /** Forgets everything: another scene, or another server. */
  start(bodies: Body[]): void {
    this.newest = this.shown = this.again = undefined;
    this.past.clear();
    this.playout.clear();
    this.decoder = new FrameDecoder(bodies);
    this.arrivals = [];
    this.clock = [];
  }

  receive(frame: Frame, now: number): void {
    const before = this.newest?.frame;
    this.newest = { frame, arrays: undefined };
    this.past.add(frame);
    // Another run of the session does not go on from the one before.
    if (before !== undefined && frame.time < before.time) this.playout.clear();
    this.playout.receive(this.newest, milliseconds(frame.unixNanos), now);
    this.arrived = now;
    this.arrivals.push(now);
    this.forget(now);
  }

  /** Frames that are put together from these shapes may come from now on. */
  learn(basis: GetBasisResponse): void {
    this.decoder.learn(basis);
  }

  /** An acknowledgement, sent and answered at these times [ms], tells the server's clock half way between. */
  acknowledged({ unixNanos }: AckFramesResponse, sent: number, answered: number): void {
    const offset = milliseconds(unixNanos) - (sent + answered) / 2;
    this.clock.push({ offset, tripTime: answered - sent });
    if (this.clock.length > mostMeasurements) this.clock.shift();
  }

  get frame(): Frame | undefined {
    return this.newest?.frame;
  }

  /** The frame of the present that is shown at `now` [ms]: the newest, or what the picture beside has come to. */
  present(now: number): Frame | undefined {
    const [newest, there] = [this.frame, this.companion?.coming(now)];
    if (newest === undefined || there === undefined) return newest;
    const ahead = newest.time - there.time;
    if (ahead <= 0 || ahead > longestWait) return newest;
    return this.past.nearest(Math.max(there.time, this.shown?.time ?? 0));
  }

  /** The newest frame, where some have come of late. */
  private coming(now: number): Frame | undefined {
    return now - this.arrived < longestQuiet ? this.frame : undefined;
  }

  /** From the oldest frame that can be looked back to, to the newest [s]. */
  get span(): { start: number; end: number } {
    return this.past.span;
  }

  /** The earlier frame that the picture shows; nothing where it shows the present. */
  get lookedAt(): Frame | undefined {
    return this.past.lookedAt;
  }

  /** Shows the moment `time` [s] again from now on, or the present. */
  lookBack(time: number | undefined): void {
    this.past.look(time);
  }

  /** The time of the frame before, or after, the one that is shown; nothing where that is the present. */
  neighbour(by: -1 | 1): number | undefined {
    return this.past.neighbour(by);
  }

  /** Of the newest frame. */
  get arrays(): FrameArrays | undefined {
    return this.newest === undefined ? undefined : this.decode(this.newest);
  }

  /** What `advance` came to last. */
  get moment(): Moment | undefined {
    return this.shown;
  }

  /**
   * Goes on to the moment that is due at `now` [ms]; whether the picture changes by it. Where a person asked for calm, or
   * the machine is slow, that is the newest frame.
   */
  advance(now: number, calm: boolean): boolean {
    this.steady.beat(now, this.changed);
    this.smooth = !calm && this.steady.fast;
    const due = this.due(now);
    this.changed = due !== undefined && due.arrays !== this.shown?.arrays;
    this.shown = due;
    return this.changed;
  }

  private due(now: number): Moment | undefined {
    const between = this.playout.at(now);
    if (this.newest === undefined || between === undefined) return undefined;
    const { lookedAt } = this.past;
    if (lookedAt !== undefined) return this.once(lookedAt);
    const { before, after, part } = this.smooth ? between : { before: this.newest, after: this.newest, part: 0 };
    const time = before.frame.time + part * (after.frame.time - before.frame.time);
    const present = this.present(now);
    if (present !== undefined && present.time < time) return this.once(present);
    return { time, arrays: blend(this.decode(before), this.decode(after), part) };
  }

  /** A frame that is looked at again is decoded again. */
  private once(frame: Frame): Moment {
    if (this.again?.frame !== frame) this.again = { frame, arrays: undefined };
    return { time: frame.time, arrays: this.decode(this.again) };
  }

  private decode(taken: Taken): FrameArrays {
    return (taken.arrays ??= this.decoder.decode(taken.frame));
  }

  rate(now: number): FrameRate {
    this.forget(now);
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

  private forget(now: number): void {
    while (this.arrivals.length > 0 && this.arrivals[0] <= now - 1000) this.arrivals.shift();
  }
}

function milliseconds(unixNanos: bigint): number {
  return Number(unixNanos / 1000n) / 1000;
}
