import type { Api } from "./api";
import { floats } from "./codec";
import { Signal } from "./signal";
import type { VertexRef } from "./viewer/clicking";

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

/** "action_line" is "action line". */
export const wordsOf = (kind: string) => kind.replaceAll("_", " ");

/** The forces that act, as the server works them out while somebody wants to know: one question at a time. */
export class Forces {
  readonly kinds = new Signal<string[]>([]);
  readonly onVertex = new Signal<ForceOnVertex[]>([]);
  /** How large the wanted kind is on each vertex of each body [N]. */
  readonly sizes = new Signal<ReadonlyMap<string, Float32Array>>(new Map());
  private asking = false;
  private answered = "";

  constructor(
    private readonly api: Api,
    private readonly sessionId: string,
  ) {}

  /** Learns which kinds there are on a body of another scene. */
  async start(body: string | undefined): Promise<void> {
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
    const [onVertex, sizes] = await Promise.all([this.of(wanted.vertex), this.sizesOf(wanted)]);
    this.asking = false;
    this.answered = question;
    this.onVertex.set(onVertex);
    this.sizes.set(sizes);
  }

  /** What was known is of another matter. */
  clear(): void {
    this.answered = "";
    this.onVertex.set([]);
    this.sizes.set(new Map());
  }

  private async of(ref: VertexRef | undefined): Promise<ForceOnVertex[]> {
    if (ref === undefined) return [];
    const answer = await this.get(ref);
    return (answer?.forces ?? []).map(({ x, y, z }, i) => ({ kind: answer!.kinds[i], force: [x, y, z] }));
  }

  private async sizesOf({ kind, bodies }: Wanted): Promise<Map<string, Float32Array>> {
    const sizes = new Map<string, Float32Array>();
    if (kind === undefined) return sizes;
    for (const body of bodies) {
      const answer = await this.get({ body, kind });
      if (answer !== undefined) sizes.set(body, floats(answer.sizes, 1, "sizes"));
    }
    return sizes;
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
