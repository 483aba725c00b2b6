import type { Frame } from "../gen/phrenic/v1/frames_pb";
import type { Body, FrameArrays } from "../geometry/bodies";
import type { Decoding } from "./decoding";
import type { DecodingAnswer, DecodingRequest } from "./decoding_messages";
import type { EncodedBasis } from "./frame_decoder";

/** Most frames that the worker has, and that wait for it: a few keep it busy, more would only be late. */
const [maxPosted, maxWaiting] = [2, 4];

/** The part of a Worker that is used. */
export interface DecodingThread {
  onmessage: ((event: MessageEvent<DecodingAnswer>) => void) | null;
  onerror: ((event: ErrorEvent) => void) | null;
  postMessage(message: DecodingRequest, transfer: Transferable[]): void;
}

type Done = Parameters<Decoding["decode"]>[1];

/** Decodes in a worker, so that the page's thread only draws. */
export class WorkerDecoding implements Decoding {
  private readonly posted = new Map<number, Done>();
  private waiting: { frame: Frame; done: Done }[] = [];
  private next = 0;
  private broken: RangeError | undefined;

  constructor(
    private readonly thread: DecodingThread = new Worker(new URL("./decoding_worker.ts", import.meta.url), {
      type: "module",
    }),
  ) {
    thread.onmessage = ({ data }) => this.answered(data);
    thread.onerror = ({ message }) => this.fail(message);
  }

  start(bodies: Body[]): void {
    this.posted.clear();
    this.waiting = [];
    this.thread.postMessage(
      {
        bodies: bodies.map(({ placement, rest, edges, triangles, firstVertex }) => ({
          ...{ placement, rest, edges, triangles, firstVertex },
        })),
      },
      [],
    );
  }

  addBasis({ epoch, shapes }: EncodedBasis): void {
    // Copies, since a view would be posted with the whole message around it.
    this.thread.postMessage({ basis: { epoch, shapes: shapes.map((bytes) => bytes.slice()) } }, []);
  }

  decode(frame: Frame, done: Done): void {
    if (this.broken !== undefined) return done(this.broken);
    this.waiting.push({ frame, done });
    this.post();
    if (this.waiting.length > maxWaiting) this.waiting.shift()?.done(undefined);
  }

  private post(): void {
    while (this.posted.size < maxPosted) {
      const next = this.waiting.shift();
      if (next === undefined) return;
      const { codec, bodies, basisEpoch } = next.frame;
      const [positions, poses] = [next.frame.positions.slice(), next.frame.poses.slice()];
      const number = this.next++;
      this.posted.set(number, next.done);
      const frame = { codec, bodies, basisEpoch, positions, poses };
      this.thread.postMessage({ number, frame }, [positions.buffer, poses.buffer]);
    }
  }

  private answered(answer: DecodingAnswer): void {
    const done = this.posted.get(answer.number);
    this.posted.delete(answer.number);
    done?.(resultOf(answer));
    this.post();
  }

  /** The worker's script cannot run: all frames fail, now and later. */
  private fail(message: string): void {
    this.broken = new RangeError(`decoder: ${message || "its worker cannot be started"}.`);
    const all = [...this.posted.values(), ...this.waiting.map(({ done }) => done)];
    this.posted.clear();
    this.waiting = [];
    for (const done of all) done(this.broken);
  }
}

function resultOf(answer: DecodingAnswer): FrameArrays | RangeError {
  if ("problem" in answer) return new RangeError(answer.problem);
  return { positions: answer.positions, poses: answer.poses };
}
