import { type Body, type FrameArrays, vertexAt } from "../geometry/bodies";
import type { Marker, VertexRef } from "../geometry/vertices";
import type { GraphSpec } from "../graphs/catalogue";
import { curveColor } from "../graphs/colors";
import { Signal } from "../state/signal";
import { TimeSeries } from "../state/time_series";
import { t } from "../language/translate";

const maxTracked = 6;
const pickedColor = "#ffffff";

/** Position of a vertex and displacement from rest [m]. */
export interface VertexState {
  position: [number, number, number];
  displacement: [number, number, number];
}

/** The picked vertex, and the vertices that this viewer tracks and plots. */
export class TrackedVertices {
  readonly picked = new Signal<VertexRef | undefined>(undefined);
  readonly tracked = new Signal<VertexRef[]>([]);
  readonly history = new TimeSeries(120);
  private graph: GraphSpec | undefined;

  constructor(private readonly bodies: () => Body[]) {}

  /** The graph of the tracked vertices; undefined if there are none. */
  get spec(): GraphSpec | undefined {
    return this.graph;
  }

  /** Tracks a vertex; the oldest of more than six is dropped. */
  track(ref: VertexRef): void {
    if (this.indexOf(ref) >= 0) return;
    this.change([...this.tracked.value, ref].slice(-maxTracked));
  }

  /** Stops tracking a vertex. */
  untrack(ref: VertexRef): void {
    this.change(this.tracked.value.filter((each) => vertexLabel(each) !== vertexLabel(ref)));
  }

  /** Forgets all vertices, for another scene. */
  clear(): void {
    this.picked.set(undefined);
    this.change([]);
  }

  /** Returns the index among the tracked vertices; -1 if the vertex is not tracked. */
  indexOf(ref: VertexRef): number {
    return this.tracked.value.findIndex((each) => vertexLabel(each) === vertexLabel(ref));
  }

  /** Records the displacements at `time` [s]. */
  receive(time: number, arrays: FrameArrays): void {
    if (this.tracked.value.length === 0) return;
    this.history.add(
      time,
      this.tracked.value.map((ref) => [
        vertexLabel(ref),
        Math.hypot(...(this.stateOf(ref, arrays)?.displacement ?? [0, 0, 0])),
      ]),
    );
  }

  /** Returns position and displacement of a vertex; undefined for an unknown body. */
  stateOf(ref: VertexRef, arrays: FrameArrays): VertexState | undefined {
    const body = this.bodies().find(({ name }) => name === ref.body);
    if (body === undefined) return undefined;
    const position = vertexAt(body, arrays, ref.vertex);
    const offset = [0, 1, 2].map((k) => position[k] - body.rest[3 * ref.vertex + k]);
    return { position, displacement: [offset[0], offset[1], offset[2]] };
  }

  /** Returns markers of the picked and the tracked vertices. */
  markers(arrays: FrameArrays): Marker[] {
    const picked = this.picked.value;
    const own = picked !== undefined && this.indexOf(picked) < 0 ? [{ ref: picked, color: pickedColor }] : [];
    const tracked = this.tracked.value.map((ref, i) => ({ ref, color: curveColor(i) }));
    return [...tracked, ...own].flatMap(({ ref, color }) => {
      const state = this.stateOf(ref, arrays);
      return state === undefined ? [] : [{ position: state.position, color }];
    });
  }

  private change(refs: VertexRef[]): void {
    const curves = refs.map((ref) => ({ key: vertexLabel(ref), name: vertexLabel(ref), factor: 1000 }));
    this.graph =
      refs.length === 0 ? undefined : { id: "tracked", title: t("Tracked vertices: displacement"), unit: "mm", curves };
    this.history.clear();
    this.tracked.set(refs);
  }
}

/** Formats "diaphragm 12". */
export function vertexLabel({ body, vertex }: VertexRef): string {
  return `${body} ${vertex}`;
}
