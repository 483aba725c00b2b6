import { Placement } from "../gen/phrenic/v1/frames_pb";
import type { Body, FrameArrays } from "../geometry/bodies";
import type { ForceQueries } from "../session/force_queries";
import type { ColorScale } from "./color_scale";
import { type FieldKind, forceKindOf, type ShapeKind, SurfaceFields } from "./fields";

/** The colours of one picture's moving tissue, by the field and on the scale that somebody chose. */
export class VertexColorizer {
  private readonly fields = new SurfaceFields();
  private bodies: Body[] = [];

  constructor(private readonly forces: ForceQueries) {}

  /** Names of the bodies that are coloured. */
  get bodyNames(): string[] {
    return this.bodies.map(({ name }) => name);
  }

  /** Another scene: its deformable bodies. */
  start(bodies: Body[]): void {
    this.bodies = bodies.filter(({ placement, triangles }) => placement === Placement.STREAMED && triangles.length > 0);
    this.fields.clear();
  }

  receive(time: number, arrays: FrameArrays): void {
    this.fields.receive(time, arrays);
  }

  /** Of each body the largest size there is now, but for one vertex in a hundred. */
  upperBounds(kind: FieldKind): number[] {
    return this.bodies.map((body) => percentile99(this.values(kind, body)));
  }

  /** Colours of the vertices of each body that is coloured, sRGB; none where nothing is chosen. */
  colors(kind: FieldKind | undefined, scale: ColorScale | undefined): Map<string, Uint8Array> {
    const result = new Map<string, Uint8Array>();
    if (kind === undefined || scale === undefined) return result;
    for (const body of this.bodies) {
      const values = this.values(kind, body);
      if (values !== undefined) result.set(body.name, scale.colors(values));
    }
    return result;
  }

  private values(kind: FieldKind, body: Body): Float32Array | undefined {
    if (forceKindOf(kind) !== undefined) return this.forces.magnitudes.value.get(body.name);
    return this.fields.of(kind as ShapeKind, body);
  }
}

function percentile99(values: Float32Array | undefined): number {
  const sizes = (values ?? new Float32Array()).map((value) => Math.abs(value) || 0).sort();
  return sizes[Math.floor(0.99 * (sizes.length - 1))] ?? 0;
}
