import type { Api } from "../connection/api";
import type { VertexRef } from "../geometry/vertices";
import { floats } from "../geometry/wire_arrays";
import { Signal } from "../state/signal";

/** A force on a vertex [N]. */
export interface VertexForce {
  kind: string;
  force: [number, number, number];
}

/** The forces to query: those on a vertex, the magnitude of one kind on all vertices, or none. */
export interface ForceRequest {
  vertex: VertexRef | undefined;
  kind: string | undefined;
  /** The bodies that are coloured by the kind. */
  bodies: string[];
}

/** Forces at one time [s]. */
interface ForceSample {
  time: number;
  vertex: VertexRef | undefined;
  kind: string | undefined;
  onVertex: VertexForce[];
  /** Magnitude on each vertex of each body [N]. */
  magnitudes: ReadonlyMap<string, Float32Array>;
}

/** Number of stored samples: 20 s at ten queries per second. */
const maxSamples = 200;
/** Largest time difference between a replayed frame and its sample [s]. */
const maxTimeDistance = 0.15;

/** Formats "action_line" as "action line". */
export const forceKindLabel = (kind: string) => kind.replaceAll("_", " ");

/** Queries the forces of the displayed state, one query at a time, and stores the answers for replay. */
export class ForceQueries {
  readonly kinds = new Signal<string[]>([]);
  readonly onVertex = new Signal<VertexForce[]>([]);
  /** Magnitude of the requested kind on each vertex of each body [N]. */
  readonly magnitudes = new Signal<ReadonlyMap<string, Float32Array>>(new Map());
  private querying = false;
  private answered = "";
  private samples: ForceSample[] = [];
  /** The replayed time [s]; undefined when live. */
  private replayTime: number | undefined;

  constructor(
    private readonly api: Api,
    private readonly sessionId: string,
  ) {}

  /** Loads the kinds of force on a body of another scene. */
  async start(body: string | undefined): Promise<void> {
    this.samples = [];
    this.replayTime = undefined;
    this.clear();
    this.kinds.set([]);
    if (body !== undefined) await this.getForces({ body });
  }

  /** Queries the forces unless those of this state are known or a query is running. `stateKey` identifies the state. */
  async query(request: ForceRequest, stateKey: string): Promise<void> {
    const question = `${stateKey} ${JSON.stringify(request)}`;
    if (this.querying || question === this.answered) return;
    if (request.vertex === undefined && request.kind === undefined) return;
    this.querying = true;
    const sample = await this.fetchSample(request);
    this.querying = false;
    this.storeSample(sample);
    if (this.replayTime !== undefined) return;
    this.answered = question;
    this.onVertex.set(sample.onVertex);
    this.magnitudes.set(sample.magnitudes);
  }

  /** Shows the stored forces near `time` [s], if there are any; undefined returns to live forces. */
  replayAt(time: number | undefined, { vertex, kind }: ForceRequest): void {
    this.replayTime = time;
    this.clear();
    if (time === undefined) return;
    if (vertex !== undefined) this.onVertex.set(this.nearest(time, (told) => sameVertex(told, vertex))?.onVertex ?? []);
    if (kind !== undefined)
      this.magnitudes.set(this.nearest(time, (told) => told.kind === kind)?.magnitudes ?? new Map());
  }

  private nearest(time: number, fits: (told: ForceSample) => boolean): ForceSample | undefined {
    const away = (each: ForceSample) => Math.abs(each.time - time);
    return this.samples
      .filter((each) => fits(each) && away(each) <= maxTimeDistance)
      .sort((a, b) => away(a) - away(b))[0];
  }

  private clear(): void {
    this.answered = "";
    this.onVertex.set([]);
    this.magnitudes.set(new Map());
  }

  /** Time that goes back means that the session was reset. */
  private storeSample(sample: ForceSample): void {
    if (sample.magnitudes.size === 0 && sample.onVertex.length === 0) return;
    if (sample.time < (this.samples.at(-1)?.time ?? 0)) this.samples = [];
    this.samples = [...this.samples.slice(1 - maxSamples), sample];
  }

  private async fetchSample({ vertex, kind, bodies }: ForceRequest): Promise<ForceSample> {
    const colored = kind === undefined ? [] : bodies;
    const [ofVertex, ...ofBodies] = await Promise.all([
      vertex === undefined ? undefined : this.getForces(vertex),
      ...colored.map((body) => this.getForces({ body, kind })),
    ]);
    const magnitudes = new Map<string, Float32Array>();
    ofBodies.forEach((response, i) => response && magnitudes.set(colored[i], floats(response.sizes, 1, "sizes")));
    const onVertex = (ofVertex?.forces ?? []).map(({ x, y, z }, i): VertexForce => {
      return { kind: ofVertex!.kinds[i], force: [x, y, z] };
    });
    return { time: (ofVertex ?? ofBodies[0])?.time ?? 0, vertex, kind, onVertex, magnitudes };
  }

  /** Returns undefined if the session has diverged or the body is not deformable. */
  private async getForces(question: { body: string; vertex?: number; kind?: string }) {
    try {
      const answer = await this.api.frames.getForces({ sessionId: this.sessionId, ...question });
      if (answer.kinds.join() !== this.kinds.value.join()) this.kinds.set(answer.kinds);
      return answer;
    } catch {
      return undefined;
    }
  }
}

function sameVertex({ vertex }: ForceSample, other: VertexRef): boolean {
  return vertex?.body === other.body && vertex.vertex === other.vertex;
}
