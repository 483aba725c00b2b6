import { Code, ConnectError } from "@connectrpc/connect";
import type { Camera } from "../gen/phrenic/v1/control_pb";
import { type AckFramesResponse, Codec, type Frame, type GetBasisResponse } from "../gen/phrenic/v1/frames_pb";
import type { CompileReport } from "../gen/phrenic/v1/report_pb";
import type { Session } from "../gen/phrenic/v1/session_pb";
import { type Body, decodeBody } from "../geometry/bodies";
import { Backoff } from "../timing/backoff";
import type { Clock } from "../timing/clock";
import { type Api, errorText } from "./api";
import { BasisFetcher } from "./basis_fetcher";
import { FrameAcknowledger } from "./frame_acknowledger";

/**
 * The state of the connection that the page shows. `retryAt` is in ms since 1970; `missing` means that the session does
 * not exist.
 */
export type ConnectionState =
  { kind: "connecting" } | { kind: "live" } | { kind: "lost"; reason: string; missing: boolean; retryAt: number };

/** Receives what the connection reads from the server. */
export interface ConnectionListener {
  state(link: ConnectionState): void;
  /** Called for a new scene with its bodies and the report of its compilation. */
  scene(bodies: Body[], report: CompileReport): void;
  /** `fresh` is true for the first state of a connection: a restarted server counts revisions from the start. */
  session(session: Session, fresh: boolean): void;
  frame(frame: Frame): void;
  /** Called for a new basis, which later frames refer to. */
  basis(basis: GetBasisResponse): void;
  /** Called with the camera of the participant in control. */
  camera?(camera: Camera): void;
  /** Called with the response to an acknowledgement and the times of request and response [ms]. */
  acknowledged(response: AckFramesResponse, sent: number, answered: number): void;
}

/** Timeout of calls, and interval of the calls that check that the server is alive [ms]. */
const callTimeout = 8000;
const pollInterval = 2000;
/** Maximum number of unacknowledged frames; the server uses fewer on slow lines. */
const maxUnackedFrames = 6;
/** Error bound of positions for fields that depend on distances between neighbours [mm]. */
const exactErrorMm = 0.01;

/** Returns an id that no other page uses. */
const newWatchId = () => `page-${Math.random().toString(36).slice(2)}`;

/**
 * Follows one session while the page is open: fetches the scene, watches frames, and reconnects with backoff after an
 * error or when the server stops answering.
 */
export class SessionConnection {
  private readonly stopped = new AbortController();
  private retryWait = new AbortController();
  private sceneHash: string | undefined;
  private epoch = 0n;
  private watchRestart = new AbortController();
  private exact = false;
  private codec = Codec.PREDICTED;
  private bodies: string[] = [];

  constructor(
    private readonly api: Api,
    readonly sessionId: string,
    private readonly listener: ConnectionListener,
    private readonly clock: Clock,
    private readonly backoff = new Backoff(),
  ) {}

  /** Resolves after `stop`. */
  async run(): Promise<void> {
    this.listener.state({ kind: "connecting" });
    while (!this.stopped.signal.aborted) {
      const error = await this.connectOnce().catch((reason: unknown) => reason);
      if (!this.stopped.signal.aborted) await this.waitBeforeRetry(error);
    }
  }

  /** Ends the connection for good. */
  stop(): void {
    this.stopped.abort();
    this.retryWait.abort();
  }

  /** Ends the wait before the next attempt. */
  retryNow(): void {
    this.retryWait.abort();
  }

  /** Requests frames that are exact enough for strains, or frames for the available bandwidth. */
  setExact(exact: boolean): void {
    if (exact === this.exact) return;
    this.exact = exact;
    this.watchRestart.abort();
  }

  /** Requests frames in this encoding. */
  setCodec(codec: Codec): void {
    if (codec === this.codec) return;
    this.codec = codec;
    this.watchRestart.abort();
  }

  /** Requests the positions of these bodies only; of all if empty. */
  setBodies(bodies: string[]): void {
    if (bodies.join("\n") === this.bodies.join("\n")) return;
    this.bodies = bodies;
    this.watchRestart.abort();
  }

  private async waitBeforeRetry(error: unknown): Promise<void> {
    const wait = this.backoff.next();
    const missing = ConnectError.from(error).code === Code.NotFound;
    this.listener.state({ kind: "lost", reason: errorText(error), missing, retryAt: this.clock.now() + wait });
    this.retryWait = new AbortController();
    await this.clock.sleep(wait, this.retryWait.signal);
  }

  /** Runs one connection until an error ends it. */
  private async connectOnce(): Promise<never> {
    const attempt = new AbortController();
    const signal = AbortSignal.any([attempt.signal, this.stopped.signal]);
    const beats = this.pollSession(attempt, signal);
    try {
      await this.loadScene(signal);
      return await this.watch(signal);
    } catch (error) {
      throw attempt.signal.aborted ? attempt.signal.reason : error;
    } finally {
      attempt.abort();
      await beats;
    }
  }

  private async loadScene(signal: AbortSignal): Promise<void> {
    const { session, report } = await this.getSession(signal);
    const hash = report?.sceneHash;
    if (report !== undefined && (hash === "" || hash !== this.sceneHash)) {
      const bodies: Body[] = [];
      for await (const message of this.api.frames.getGeometry({ sessionId: this.sessionId }, { signal })) {
        bodies[message.bodyIndex] = decodeBody(message);
      }
      this.listener.scene(bodies, report);
      this.sceneHash = hash;
    }
    if (session === undefined) return;
    this.epoch = session.epoch;
    this.listener.session(session, true);
  }

  private async watch(signal: AbortSignal): Promise<never> {
    for (;;) {
      this.watchRestart = new AbortController();
      const { signal: changed } = this.watchRestart;
      await this.watchOnce(AbortSignal.any([signal, changed])).catch((error: unknown) => {
        if (!changed.aborted || signal.aborted) throw error;
      });
    }
  }

  private async watchOnce(signal: AbortSignal): Promise<never> {
    const names = { sessionId: this.sessionId, watchId: newWatchId() };
    const learner = new BasisFetcher(
      () => this.api.frames.getBasis({ sessionId: this.sessionId }, { signal, timeoutMs: callTimeout }),
      (basis) => this.listener.basis(basis),
    );
    const acknowledger = new FrameAcknowledger(
      (sequence) =>
        this.api.frames.ackFrames(
          { ...names, sequence, basisEpoch: learner.epoch },
          { signal, timeoutMs: callTimeout },
        ),
      this.clock,
      signal,
      (response, sent, at) => {
        this.listener.acknowledged(response, sent, at);
        learner.offered(response.basisEpoch);
      },
    );
    const maxErrorMm = this.exact ? exactErrorMm : undefined;
    const request = { ...names, codec: this.codec, bodies: this.bodies, maxUnackedFrames, maxErrorMm };
    for await (const { event } of this.api.frames.watchFrames(request, { signal })) {
      this.backoff.reset();
      this.listener.state({ kind: "live" });
      if (event.case === "session") this.listener.session(event.value, false);
      if (event.case === "camera") this.listener.camera?.(event.value);
      if (event.case !== "frame") continue;
      this.listener.frame(event.value);
      acknowledger.received(event.value.sequence);
    }
    throw new ConnectError("The server closed the connection.", Code.Unavailable);
  }

  /** A paused session sends no frames, so polling tells a quiet server from a dead one. */
  private async pollSession(attempt: AbortController, signal: AbortSignal): Promise<void> {
    for (;;) {
      await this.clock.sleep(pollInterval, signal);
      if (signal.aborted) return;
      try {
        const { session } = await this.getSession(signal);
        if (session === undefined) continue;
        // After a failover, the open stream belongs to the previous server.
        if (session.epoch !== this.epoch) throw new ConnectError("The session has moved.", Code.Unavailable);
        this.listener.session(session, false);
      } catch (error) {
        attempt.abort(error);
      }
    }
  }

  private getSession(signal: AbortSignal) {
    return this.api.sessions.getSession({ sessionId: this.sessionId }, { signal, timeoutMs: callTimeout });
  }
}
