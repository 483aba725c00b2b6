import { create } from "@bufbuild/protobuf";
import { type Frame, FrameSchema } from "../gen/phrenic/v1/frames_pb";
import {
  type ReadSamplesResponse,
  type Sample,
  type SampledQuantity,
  SampledQuantity_Kind,
} from "../gen/phrenic/v1/samples_pb";
import type { Clock } from "../timing/clock";
import { type Api, errorText } from "./api";

/** Time between two reads while samples come, while none come, and after an error [ms]. */
const betweenReads = 200;
const whileIdle = 1000;
const afterError = 5000;
const callTimeout = 8000;

/** Receives what a feed reads. */
export interface SampleListener {
  /**
   * The numbers of one sample, as a frame without positions. `present` is true for the state when reading began, which
   * lies between two samples.
   */
  sample(numbers: Frame, present: boolean): void;
  /** Samples before the next one are missing: the page was too slow, or the server kept none for it. */
  gap?(): void;
  /** Why the last read failed; empty after one that did not. */
  refused?(reason: string): void;
}

/**
 * Reads the samples of a session by simulated time, all of them and in order, while the page is open: also while it is
 * hidden, or draws few pictures. It reads several times a second and holds no stream open, because browsers open only
 * six connections to a server.
 */
export class SampleFeed {
  private readonly stopped = new AbortController();
  private rest = new AbortController();
  private reading: Promise<boolean> | undefined;
  private quantities: SampledQuantity[] = [];
  private position = { track: 0n, last: 0n };

  constructor(
    private readonly api: Api,
    private readonly sessionId: string,
    private readonly listener: SampleListener,
    private readonly clock: Clock,
  ) {}

  /** Resolves after `stop`. */
  async run(): Promise<void> {
    const { signal } = this.stopped;
    while (!signal.aborted) {
      this.rest = new AbortController();
      let [wait, ends] = [afterError, signal];
      try {
        wait = (await this.read()) ? betweenReads : whileIdle;
        ends = AbortSignal.any([signal, this.rest.signal]);
        this.listener.refused?.("");
      } catch (error) {
        if (!signal.aborted) this.listener.refused?.(errorText(error));
      }
      await this.clock.sleep(wait, ends);
    }
  }

  /** Ends the feed for good. */
  stop(): void {
    this.stopped.abort();
  }

  /** Reads soon: the session has begun to play, or was reset. The pause after an error stays as long as it is. */
  wake(): void {
    this.rest.abort();
  }

  /** Resolves when the samples up to now were received. An error is that of a lost connection: `run` tries again. */
  async catchUp(): Promise<void> {
    await this.reading?.catch(() => undefined);
    await this.read().catch(() => undefined);
  }

  /** Reads all that has come; true if there was any. One read at a time, so that each sample comes once. */
  private read(): Promise<boolean> {
    this.reading ??= this.readAll().finally(() => (this.reading = undefined));
    return this.reading;
  }

  private async readAll(): Promise<boolean> {
    const { signal } = this.stopped;
    let came = false;
    for (let more = true; more && !signal.aborted;) {
      const request = { sessionId: this.sessionId, probes: true, ...this.position };
      const response = await this.api.samples.readSamples(request, { signal, timeoutMs: callTimeout });
      more = response.more;
      came = this.receive(response) || came;
    }
    return came;
  }

  private receive({ batch }: ReadSamplesResponse): boolean {
    if (batch === undefined) return false;
    if (batch.quantities.length > 0) this.quantities = batch.quantities;
    const { track } = this.position;
    this.position = { track: batch.track, last: batch.last };
    if (batch.leftOut > 0n || (track !== 0n && batch.track !== track)) this.listener.gap?.();
    if (batch.present !== undefined) this.listener.sample(this.numbers(batch.present), true);
    for (const sample of batch.samples) this.listener.sample(this.numbers(sample), false);
    return batch.samples.length > 0;
  }

  private numbers({ tick, time, breath, values }: Sample): Frame {
    const named = this.quantities.map(({ kind, name, unit }, i) => ({ kind, name, unit, value: values[i] }));
    const probes = named.filter(({ kind }) => kind === SampledQuantity_Kind.PROBE);
    return create(FrameSchema, {
      tick,
      time,
      breath,
      measures: named
        .filter(({ kind }) => kind === SampledQuantity_Kind.MEASURE)
        .map(({ name, unit, value }) => ({ name, unit, value })),
      probes: probes.map(({ name, value }) => ({ name, dz: value })),
    });
  }
}
