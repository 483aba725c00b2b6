import { type ClassAnswerSchema, type SubmitAnswerRequest } from "../../../web/src/gen/phrenic/v1/answers_pb";
import { create, type MessageInitShape } from "@bufbuild/protobuf";
import { Code, ConnectError, createRouterTransport } from "@connectrpc/connect";
import { createApi } from "../../../web/src/connection/api";
import {
  type CompareRequest,
  type CompareResponseSchema,
  CompareService,
} from "../../../web/src/gen/phrenic/v1/compare_pb";
import {
  type Codec,
  FrameService,
  GetBasisResponseSchema,
  type GetForcesRequest,
  GetGeometryResponseSchema,
  Placement,
  type WatchFramesResponseSchema,
} from "../../../web/src/gen/phrenic/v1/frames_pb";
import type { ParametersSchema } from "../../../web/src/gen/phrenic/v1/parameters_pb";
import type { PresetSchema } from "../../../web/src/gen/phrenic/v1/scene_pb";
import {
  type CreateSessionRequest,
  type Pull,
  type SceneSource,
  SessionSchema,
  SessionService,
  SessionState,
} from "../../../web/src/gen/phrenic/v1/session_pb";
import { ReferenceService } from "../../../web/src/gen/phrenic/v1/references_pb";
import {
  type ReadSamplesRequest,
  type SampleBatchSchema,
  SampleService,
} from "../../../web/src/gen/phrenic/v1/samples_pb";
import { StudyService, StudyState } from "../../../web/src/gen/phrenic/v1/study_pb";
import {
  type GetTissueResponseSchema,
  type PointReadingSchema,
  TissueService,
} from "../../../web/src/gen/phrenic/v1/tissue_pb";

type ComparisonEvent = MessageInitShape<typeof CompareResponseSchema>["event"];
type Event = MessageInitShape<typeof WatchFramesResponseSchema>["event"];

/** Returns the bytes of numbers in machine order. */
export function bytesOf(numbers: Float32Array | Uint32Array): Uint8Array<ArrayBuffer> {
  return new Uint8Array(numbers.buffer.slice(0) as ArrayBuffer);
}

/** One triangle with corners at 0, x and y. */
export function triangleBody(fields: MessageInitShape<typeof GetGeometryResponseSchema>) {
  return create(GetGeometryResponseSchema, {
    bodyCount: 1,
    name: "triangle",
    placement: Placement.STREAMED,
    restPositions: bytesOf(new Float32Array([0, 0, 0, 1, 0, 0, 0, 1, 0])),
    triangles: bytesOf(new Uint32Array([0, 1, 2])),
    ...fields,
  });
}

/** An in-process server with one session. Tests control its answers and read the requests that it received. */
export class FakeServer {
  session = create(SessionSchema, {
    id: "thorax",
    scene: "thorax",
    state: SessionState.PLAYING,
    revision: 1n,
  });
  sessions = [this.session];
  sceneHash = "abc";
  down = false;
  /** Why playing, pausing and reading samples or references are refused; empty if they are not. */
  refusal = "";
  /** Number of calls for references. */
  referenceReads = 0;
  geometryCalls = 0;
  /** Sequence numbers of acknowledged frames. */
  readonly acknowledged: bigint[] = [];
  readonly updates: object[] = [];
  readonly pulls: Pull[] = [];
  /** Answers to lessons that were submitted, and those that the server lists. */
  readonly answers: SubmitAnswerRequest[] = [];
  classAnswers: MessageInitShape<typeof ClassAnswerSchema>[] = [];
  /** Requests to create sessions, steps (expected tick, number of ticks) and deleted sessions. */
  readonly created: CreateSessionRequest[] = [];
  readonly stepRequests: [bigint | undefined, bigint][] = [];
  readonly deleted: string[] = [];
  /**
   * Played sessions with the session they are synchronised with; paused sessions; stepped sessions with their ticks.
   */
  readonly played: [string, string][] = [];
  readonly paused: string[] = [];
  readonly stepped: [string, bigint][] = [];
  /** State that a pause returns, by session. */
  readonly pausedSessions = new Map<string, typeof this.session>();
  /** Requested error bound of each watch [mm]. */
  readonly errorBounds: (number | undefined)[] = [];
  readonly codecs: Codec[] = [];
  readonly chosenBodies: string[][] = [];
  /** The current basis, and the basis epochs that viewers reported. */
  basis = create(GetBasisResponseSchema, {});
  readonly reportedBasisEpochs: bigint[] = [];
  /** Requests for forces. */
  readonly forceRequests: object[] = [];
  /** Time [s] and force magnitudes [N] of the answers to force requests. */
  forceResponse = { time: 0, sizes: [0.5, 0.25] };
  /** The lungs' tissue at one time [s], each lung with these amplitudes [m]; undefined for a scene without lungs. */
  tissue:
    | {
        lungs: MessageInitShape<typeof GetTissueResponseSchema>[];
        time: number;
        amplitudes: number[];
        points: MessageInitShape<typeof PointReadingSchema>[];
      }
    | undefined;
  readonly tissueCalls: ("get" | "read")[] = [];
  /** Batches of samples that the next reads return, and the positions that were read from. */
  sampleBatches: MessageInitShape<typeof SampleBatchSchema>[] = [];
  readonly sampleReads: ReadSamplesRequest[] = [];
  readonly comparisons: CompareRequest[] = [];
  /** Events that a comparison sends in this order; promises are awaited. */
  comparisonEvents: (ComparisonEvent | Promise<ComparisonEvent>)[] = [];
  /** Presets of the scene. */
  presets: MessageInitShape<typeof PresetSchema>[] = [];
  sceneParameters: MessageInitShape<typeof ParametersSchema> = {};
  private emitters = new Set<(event: Event | "end") => void>();

  readonly api = createApi(
    createRouterTransport(({ service }) => {
      service(SessionService, {
        getSession: () =>
          this.answer({
            session: this.session,
            report: { sceneHash: this.sceneHash },
            presets: this.presets,
            sceneParameters: this.sceneParameters,
          }),
        listSessions: () => this.answer({ sessions: this.sessions }),
        createSession: (request) => {
          this.created.push(request);
          return this.answer({ session: { id: "thorax-2", scene: "thorax" } });
        },
        forkSession: () => this.answer({ session: { id: "thorax-2", scene: "thorax" } }),
        deleteSession: ({ sessionId }) => {
          this.deleted.push(sessionId);
          return this.answer({});
        },
        stepSession: ({ sessionId, ticks, expectedTick }) => {
          this.stepRequests.push([expectedTick, ticks]);
          this.stepped.push([sessionId, ticks]);
          return this.answer({});
        },
        playSession: ({ sessionId, inStepWith }) => {
          this.played.push([sessionId, inStepWith]);
          return this.answerUnlessRefused({ session: this.session });
        },
        pauseSession: ({ sessionId }) => {
          this.paused.push(sessionId);
          return this.answerUnlessRefused({ session: this.pausedSessions.get(sessionId) ?? this.session });
        },
        updateParameters: ({ parameters, preset }) => {
          this.updates.push(preset === "" ? parameters! : { preset });
          return this.answer({ session: this.session });
        },
        submitAnswer: (request) => {
          this.answers.push(request);
          return this.answer({ attempts: 1 });
        },
        listAnswers: () => this.answer({ answers: this.classAnswers }),
        pullSession: ({ pulls }) => {
          this.pulls.push(...pulls);
          return this.answer({ session: this.session });
        },
      });
      service(FrameService, this.streams());
      service(CompareService, this.comparing());
      service(StudyService, this.studying());
      service(TissueService, this.tissueReader());
      service(ReferenceService, {
        getReferences: () => {
          this.referenceReads++;
          return this.answerUnlessRefused({ ranges: [], curves: [] });
        },
      });
      service(SampleService, {
        readSamples: (request) => {
          this.sampleReads.push(request);
          const batch = this.sampleBatches.shift() ?? { track: request.track, last: request.last };
          return this.answerUnlessRefused({ batch, more: this.sampleBatches.length > 0 });
        },
      });
    }),
  );

  private tissueReader() {
    const server = this;
    return {
      async *getTissue() {
        server.tissueCalls.push("get");
        await Promise.resolve();
        if (server.tissue === undefined) throw new ConnectError("the scene lacks lungs", Code.FailedPrecondition);
        yield* server.tissue.lungs;
      },
      readTissue() {
        server.tissueCalls.push("read");
        const { lungs, time, amplitudes, points } = server.tissue!;
        const read = lungs.map(({ name }) => ({
          name,
          amplitudes: bytesOf(new Float32Array(amplitudes)),
          regions: [],
        }));
        return server.answer({ time, lungs: read, points });
      },
    };
  }

  /** Sends an event to every watcher. */
  send(event: Event): void {
    for (const emit of this.emitters) emit(event);
  }

  /** Behaves like a killed server: streams end and calls fail until `down` is false again. */
  kill(): void {
    this.down = true;
    for (const emit of this.emitters) emit("end");
  }

  private streams() {
    const server = this;
    return {
      ackFrames({ sequence, basisEpoch }: { sequence: bigint; basisEpoch: bigint }) {
        server.acknowledged.push(sequence);
        server.reportedBasisEpochs.push(basisEpoch);
        return server.answer({ unixNanos: 1_000_000_000n, framesPerSecond: 30, basisEpoch: server.basis.epoch });
      },
      getBasis() {
        return server.answer(server.basis);
      },
      getForces({ body, vertex, kind }: GetForcesRequest) {
        server.forceRequests.push({
          body,
          ...(vertex === undefined ? {} : { vertex }),
          ...(kind === "" ? {} : { kind }),
        });
        const forces = vertex === undefined ? [] : [1, 2].map(() => ({ x: 1, y: 2, z: 3 }));
        const sizes = kind === "" ? new Uint8Array() : bytesOf(new Float32Array(server.forceResponse.sizes));
        return server.answer({ kinds: ["springs", "net"], time: server.forceResponse.time, forces, sizes });
      },
      async *getGeometry() {
        server.geometryCalls++;
        yield server.answer(triangleBody({}));
      },
      async *watchFrames(
        { maxErrorMm, codec, bodies }: { maxErrorMm?: number; codec: Codec; bodies: string[] },
        { signal }: { signal: AbortSignal },
      ) {
        server.errorBounds.push(maxErrorMm);
        server.codecs.push(codec);
        server.chosenBodies.push(bodies);
        yield server.answer({
          event: { case: "session" as const, value: server.session },
        });
        for (;;) {
          const event = await server.next(signal);
          if (event === "end") throw new ConnectError("connection reset", Code.Unavailable);
          yield { event };
        }
      },
    };
  }

  private studying() {
    const server = this;
    const id = "cost-thorax";
    return {
      createStudy({ source }: { source?: SceneSource }) {
        if (source?.source.value === "") throw new ConnectError("source.name: there is no scene", Code.InvalidArgument);
        return server.answer({ study: { id, state: StudyState.RUNNING } });
      },
      async *watchStudy() {
        yield server.answer({ study: { id, state: StudyState.RUNNING, progress: 0.5 } });
        yield server.answer({ study: { id, state: StudyState.DONE, progress: 1, result: { tookS: 2 } } });
      },
      listStudies: () => server.answer({ studies: [] }),
      deleteStudy: () => server.answer({}),
    };
  }

  private comparing() {
    const server = this;
    return {
      async *compare(request: CompareRequest) {
        server.comparisons.push(request);
        for (const event of server.comparisonEvents) yield server.answer({ event: await event });
      },
    };
  }

  private next(signal: AbortSignal): Promise<Event | "end"> {
    return new Promise((resolve) => {
      const emit = (event: Event | "end") => {
        this.emitters.delete(emit);
        resolve(event);
      };
      this.emitters.add(emit);
      signal.addEventListener("abort", () => emit("end"));
    });
  }

  private answerUnlessRefused<T>(value: T): T {
    if (this.refusal !== "") throw new ConnectError(this.refusal, Code.ResourceExhausted);
    return this.answer(value);
  }

  private answer<T>(value: T): T {
    if (this.down) throw new ConnectError("connection refused", Code.Unavailable);
    return value;
  }
}
