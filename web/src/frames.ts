import type { Body, FrameArrays } from "./codec";
import { FrameDecoder } from "./frame_decoder";
import type { AckFramesResponse, Frame } from "./gen/phrenic/v1/frames_pb";

/** How frames arrive. */
export interface FrameRate {
  framesPerSecond: number;
  /** How old the newest frame was when it came [ms], by the server's clock; undefined until that is known. */
  age: number | undefined;
  /** How far a vertex may be from its own [mm]. */
  errorBound: number;
}

/** Measurements of the server's clock that are kept: the quickest of them counts. */
const mostMeasurements = 30;

/** The newest frame, decoded only when somebody draws it, and the rate over the last second. */
export class Frames {
  private newest: Frame | undefined;
  private decoded: FrameArrays | undefined;
  private decoder = new FrameDecoder([]);
  private arrivals: number[] = [];
  private clock: { offset: number; tripTime: number }[] = [];

  /** Forgets everything: another scene, or another server. */
  start(bodies: Body[]): void {
    this.newest = undefined;
    this.decoded = undefined;
    this.decoder = new FrameDecoder(bodies);
    this.arrivals = [];
    this.clock = [];
  }

  receive(frame: Frame, now: number): void {
    this.newest = frame;
    this.decoded = undefined;
    this.arrivals.push(now);
    this.forget(now);
  }

  /** An acknowledgement, sent and answered at these times [ms], tells the server's clock half way between. */
  acknowledged({ unixNanos }: AckFramesResponse, sent: number, answered: number): void {
    const offset = milliseconds(unixNanos) - (sent + answered) / 2;
    this.clock.push({ offset, tripTime: answered - sent });
    if (this.clock.length > mostMeasurements) this.clock.shift();
  }

  get frame(): Frame | undefined {
    return this.newest;
  }

  get arrays(): FrameArrays | undefined {
    if (this.newest !== undefined) this.decoded ??= this.decoder.decode(this.newest);
    return this.decoded;
  }

  rate(now: number): FrameRate {
    this.forget(now);
    return { framesPerSecond: this.arrivals.length, age: this.age(), errorBound: this.newest?.maxErrorMm ?? 0 };
  }

  private age(): number | undefined {
    const arrived = this.arrivals.at(-1);
    if (this.newest === undefined || arrived === undefined || this.clock.length === 0) return undefined;
    const best = this.clock.reduce((a, b) => (b.tripTime < a.tripTime ? b : a));
    return arrived + best.offset - milliseconds(this.newest.unixNanos);
  }

  private forget(now: number): void {
    while (this.arrivals.length > 0 && this.arrivals[0] <= now - 1000) this.arrivals.shift();
  }
}

function milliseconds(unixNanos: bigint): number {
  return Number(unixNanos / 1000n) / 1000;
}
