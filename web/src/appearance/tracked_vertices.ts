import { type Body, type FrameArrays, vertexAt } from "../geometry/bodies";
import type { Marker, VertexRef } from "../geometry/vertices";
import type { GraphSpec } from "../graphs/catalogue";
import { curveColor } from "../graphs/colors";
import { Signal } from "../state/signal";
import { History } from "../state/time_series";

const mostFollowed = 6;
const pickedColor = "#ffffff";

/** Where a vertex is, and how far from its rest [m]. */
export interface Standing {
  place: [number, number, number];
  way: [number, number, number];
}

/** The vertex that was picked last, and those that this viewer follows: probes of its own. */
export class Following {
  readonly picked = new Signal<VertexRef | undefined>(undefined);
  readonly all = new Signal<VertexRef[]>([]);
  readonly history = new History(120);
  private graph: GraphSpec | undefined;

  constructor(private readonly bodies: () => Body[]) {}

  get spec(): GraphSpec | undefined {
    return this.graph;
  }

  follow(ref: VertexRef): void {
    if (this.order(ref) >= 0) return;
    this.change([...this.all.value, ref].slice(-mostFollowed));
  }

  leave(ref: VertexRef): void {
    this.change(this.all.value.filter((each) => nameOf(each) !== nameOf(ref)));
  }

  /** Another scene. */
  clear(): void {
    this.picked.set(undefined);
    this.change([]);
  }

  /** The place of a vertex among those that are followed; -1 where it is not. */
  order(ref: VertexRef): number {
    return this.all.value.findIndex((each) => nameOf(each) === nameOf(ref));
  }

  /** Takes note of where they are at `time` [s]. */
  receive(time: number, arrays: FrameArrays): void {
    if (this.all.value.length === 0) return;
    this.history.add(
      time,
      this.all.value.map((ref) => [nameOf(ref), Math.hypot(...(this.standing(ref, arrays)?.way ?? [0, 0, 0]))]),
    );
  }

  standing(ref: VertexRef, arrays: FrameArrays): Standing | undefined {
    const body = this.bodies().find(({ name }) => name === ref.body);
    if (body === undefined) return undefined;
    const place = vertexAt(body, arrays, ref.vertex);
    const way = [0, 1, 2].map((k) => place[k] - body.rest[3 * ref.vertex + k]);
    return { place, way: [way[0], way[1], way[2]] };
  }

  markers(arrays: FrameArrays): Marker[] {
    const picked = this.picked.value;
    const own = picked !== undefined && this.order(picked) < 0 ? [{ ref: picked, color: pickedColor }] : [];
    const followed = this.all.value.map((ref, i) => ({ ref, color: curveColor(i) }));
    return [...followed, ...own].flatMap(({ ref, color }) => {
      const standing = this.standing(ref, arrays);
      return standing === undefined ? [] : [{ place: standing.place, color }];
    });
  }

  private change(refs: VertexRef[]): void {
    const curves = refs.map((ref) => ({ key: nameOf(ref), name: nameOf(ref), factor: 1000 }));
    this.graph =
      refs.length === 0 ? undefined : { id: "followed", title: "Followed vertices: from rest", unit: "mm", curves };
    this.history.clear();
    this.all.set(refs);
  }
}

export function nameOf({ body, vertex }: VertexRef): string {
  return `${body} ${vertex}`;
}
