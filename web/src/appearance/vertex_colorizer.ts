import { Placement } from "../gen/phrenic/v1/frames_pb";
import type { Body, FrameArrays } from "../geometry/bodies";
import type { LungTissue } from "../lungs/lung_tissue";
import type { ForceQueries } from "../session/force_queries";
import type { ColorScale } from "./color_scale";
import { type FieldKind, forceKindOf, type ShapeKind, SurfaceFields, tissueKindOf } from "./fields";

/** Computes the vertex colours of the deformable bodies of one view, or of its lungs. */
export class VertexColorizer {
  private readonly fields = new SurfaceFields();
  private bodies: Body[] = [];

  constructor(
    private readonly forces: ForceQueries,
    private readonly lungs?: LungTissue,
  ) {}

  /** Names of the coloured bodies. */
  get bodyNames(): string[] {
    return this.bodies.map(({ name }) => name);
  }

  /** Starts another scene with these deformable bodies. */
  start(bodies: Body[]): void {
    this.bodies = bodies.filter(({ placement, triangles }) => placement === Placement.STREAMED && triangles.length > 0);
    this.fields.clear();
  }

  /** Sets the displayed frame at `time` [s]. */
  receive(time: number, arrays: FrameArrays): void {
    this.fields.receive(time, arrays);
    this.lungs?.receive(time);
  }

  /** Returns the 99th percentile of the magnitudes of each body, in the unit of the field. */
  upperBounds(kind: FieldKind): number[] {
    return this.bodiesOf(kind).map((body) => percentile99(this.values(kind, body)));
  }

  /** Returns the vertex colours of each coloured body as sRGB bytes; empty without a field. */
  colors(kind: FieldKind | undefined, scale: ColorScale | undefined): Map<string, Uint8Array> {
    const result = new Map<string, Uint8Array>();
    if (kind === undefined || scale === undefined) return result;
    for (const body of this.bodiesOf(kind)) {
      const values = this.values(kind, body);
      if (values !== undefined) result.set(body.name, scale.colors(values));
    }
    return result;
  }

  private bodiesOf(kind: FieldKind): Body[] {
    return tissueKindOf(kind) === undefined ? this.bodies : (this.lungs?.lungBodies ?? []);
  }

  private values(kind: FieldKind, body: Body): Float32Array | undefined {
    const tissue = tissueKindOf(kind);
    if (tissue !== undefined) return this.lungs?.of(tissue, body);
    if (forceKindOf(kind) !== undefined) return this.forces.magnitudes.value.get(body.name);
    return this.fields.of(kind as ShapeKind, body);
  }
}

function percentile99(values: Float32Array | undefined): number {
  const sizes = (values ?? new Float32Array()).map((value) => Math.abs(value) || 0).sort();
  return sizes[Math.floor(0.99 * (sizes.length - 1))] ?? 0;
}
