import type { Api } from "../connection/api";
import type { VertexRef } from "../geometry/vertices";
import { floats } from "../geometry/wire_arrays";
import { Signal } from "../state/signal";

/** A force on a vertex [N]. */
export interface ForceOnVertex {
  kind: string;
  force: [number, number, number];
}

/** What is to be known of the forces: those on a vertex, how large one kind is everywhere, or nothing. */
export interface Wanted {
  vertex: VertexRef | undefined;
  kind: string | undefined;
  /** The bodies that are coloured by the kind. */
  bodies: string[];
}

/** What the server told of one moment [s], of a vertex and of a kind. */
interface Told {
  time: number;
  vertex: VertexRef | undefined;
  kind: string | undefined;
  onVertex: ForceOnVertex[];
  /** [N] a vertex of each body. */
  sizes: ReadonlyMap<string, Float32Array>;
}

/** So many moments are kept: the last 20 s, asked for ten times a second. */
const mostTold = 200;
/** What was told of a moment is shown for moments this near [s]. */
const near = 0.15;

/** "action_line" is "action line". */
export const wordsOf = (kind: string) => kind.replaceAll("_", " ");

/**
 * The forces that act, as the server works them out while somebody wants to know: one question at a time. What was told
 * is kept for who looks back.
 */
export class Forces {
  readonly kinds = new Signal<string[]>([]);
  readonly onVertex = new Signal<ForceOnVertex[]>([]);
  /** How large the wanted kind is on each vertex of each body [N]. */
  readonly sizes = new Signal<ReadonlyMap<string, Float32Array>>(new Map());
  private asking = false;
  private answered = "";
  private told: Told[] = [];
  /** The earlier moment that is looked at [s]. */
  private back: number | undefined;

  constructor(
    private readonly api: Api,
    private readonly sessionId: string,
  ) {}

  /** Learns which kinds there are on a body of another scene. */
  async start(body: string | undefined): Promise<void> {
    this.told = [];
    this.back = undefined;
    this.clear();
    this.kinds.set([]);
    if (body !== undefined) await this.get({ body });
  }

  /** Asks for what is wanted of the state that a viewer saw last, unless that is known or being asked for. */
  async ask(wanted: Wanted, seen: string): Promise<void> {
    const question = `${seen} ${JSON.stringify(wanted)}`;
    if (this.asking || question === this.answered) return;
    if (wanted.vertex === undefined && wanted.kind === undefined) return;
    this.asking = true;
    const told = await this.tell(wanted);
    this.asking = false;
    this.keep(told);
    if (this.back !== undefined) return;
    this.answered = question;
    this.onVertex.set(told.onVertex);
    this.sizes.set(told.sizes);
  }

  /** Shows what was told of the moment `time` [s], where that is known; for the present, what is told next. */
  recall(time: number | undefined, { vertex, kind }: Wanted): void {
    this.back = time;
    this.clear();
    if (time === undefined) return;
    if (vertex !== undefined) this.onVertex.set(this.nearest(time, (told) => sameVertex(told, vertex))?.onVertex ?? []);
    if (kind !== undefined) this.sizes.set(this.nearest(time, (told) => told.kind === kind)?.sizes ?? new Map());
  }

  private nearest(time: number, fits: (told: Told) => boolean): Told | undefined {
    const away = (each: Told) => Math.abs(each.time - time);
    return this.told.filter((each) => fits(each) && away(each) <= near).sort((a, b) => away(a) - away(b))[0];
  }

  private clear(): void {
    this.answered = "";
    this.onVertex.set([]);
    this.sizes.set(new Map());
  }

  /** Time that goes back is another run. */
  private keep(told: Told): void {
    if (told.sizes.size === 0 && told.onVertex.length === 0) return;
    if (told.time < (this.told.at(-1)?.time ?? 0)) this.told = [];
    this.told = [...this.told.slice(1 - mostTold), told];
  }

  private async tell({ vertex, kind, bodies }: Wanted): Promise<Told> {
    const colored = kind === undefined ? [] : bodies;
    const [ofVertex, ...ofBodies] = await Promise.all([
      vertex === undefined ? undefined : this.get(vertex),
      ...colored.map((body) => this.get({ body, kind })),
    ]);
    const sizes = new Map<string, Float32Array>();
    ofBodies.forEach((answer, i) => answer && sizes.set(colored[i], floats(answer.sizes, 1, "sizes")));
    const onVertex = (ofVertex?.forces ?? []).map(({ x, y, z }, i): ForceOnVertex => {
      return { kind: ofVertex!.kinds[i], force: [x, y, z] };
    });
    return { time: (ofVertex ?? ofBodies[0])?.time ?? 0, vertex, kind, onVertex, sizes };
  }

  /** Nothing where the server does not say: the session has diverged, or the vertex is not a deformable body's. */
  private async get(question: { body: string; vertex?: number; kind?: string }) {
    try {
      const answer = await this.api.frames.getForces({ sessionId: this.sessionId, ...question });
      if (answer.kinds.join() !== this.kinds.value.join()) this.kinds.set(answer.kinds);
      return answer;
    } catch {
      return undefined;
    }
  }
}

function sameVertex({ vertex }: Told, other: VertexRef): boolean {
  return vertex?.body === other.body && vertex.vertex === other.vertex;
}
