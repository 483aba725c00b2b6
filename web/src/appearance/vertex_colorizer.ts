import { Placement } from "../gen/phrenic/v1/frames_pb";
import type { Body, FrameArrays } from "../geometry/bodies";
import type { Forces } from "../session/force_queries";
import type { ColorScale } from "./color_scale";
import { type FieldKind, Fields, forceOf, type ShapeKind } from "./fields";

/** The colours of one picture's moving tissue, by the field and on the scale that somebody chose. */
export class Painter {
  private readonly fields = new Fields();
  private bodies: Body[] = [];

  constructor(private readonly forces: Forces) {}

  /** Names of the bodies that are coloured. */
  get names(): string[] {
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
  largest(kind: FieldKind): number[] {
    return this.bodies.map((body) => largestOf(this.values(kind, body)));
  }

  /** Colours of the vertices of each body that is coloured, sRGB; none where nothing is chosen. */
  paint(kind: FieldKind | undefined, scale: ColorScale | undefined): Map<string, Uint8Array> {
    const painted = new Map<string, Uint8Array>();
    if (kind === undefined || scale === undefined) return painted;
    for (const body of this.bodies) {
      const values = this.values(kind, body);
      if (values !== undefined) painted.set(body.name, scale.paint(values));
    }
    return painted;
  }

  private values(kind: FieldKind, body: Body): Float32Array | undefined {
    if (forceOf(kind) !== undefined) return this.forces.sizes.value.get(body.name);
    return this.fields.of(kind as ShapeKind, body);
  }
}

function largestOf(values: Float32Array | undefined): number {
  const sizes = (values ?? new Float32Array()).map((value) => Math.abs(value) || 0).sort();
  return sizes[Math.floor(0.99 * (sizes.length - 1))] ?? 0;
}
