import type { Body, FrameArrays } from "./codec";
import { ColorScale, topFor } from "./color_scale";
import { type FieldKind, Fields, forceOf, infoOf, type ShapeKind } from "./fields";
import type { Forces } from "./forces";
import { Placement } from "./gen/phrenic/v1/frames_pb";
import { Signal } from "./signal";

/** Colours the moving tissue by a field of it, on a scale that stays as it is until somebody changes it. */
export class Coloring {
  /** What is coloured by; nothing where bodies have their own colours. */
  readonly kind = new Signal<FieldKind | undefined>(undefined);
  readonly scale = new Signal<ColorScale | undefined>(undefined);
  private readonly fields = new Fields();
  private bodies: Body[] = [];
  /** The scale is to be fitted once there are values. */
  private unfitted = false;

  constructor(private readonly forces: Forces) {
    forces.sizes.subscribe((sizes) => {
      if (this.unfitted && sizes.size > 0) this.fit();
    });
  }

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
    if (this.kind.value !== undefined) this.fields.receive(time, arrays);
  }

  choose(kind: FieldKind | undefined): void {
    this.kind.set(kind);
    this.fit();
    this.unfitted = forceOf(kind) !== undefined;
  }

  /** A scale that ends at the largest value there is now, but for one vertex in a hundred. */
  fit(): void {
    const info = infoOf(this.kind.value);
    if (info === undefined) return this.scale.set(undefined);
    this.unfitted = false;
    const largest = this.bodies.map((body) => largestOf(this.values(info.kind, body)));
    this.setTop(topFor(largest, info.least));
  }

  setTop(top: number): void {
    const info = infoOf(this.kind.value);
    if (info !== undefined && top > 0) this.scale.set(new ColorScale(top, info.unit, info.diverging));
  }

  /** Colours of the vertices of each body that is coloured, sRGB. */
  paint(): Map<string, Uint8Array> {
    const painted = new Map<string, Uint8Array>();
    const [kind, scale] = [this.kind.value, this.scale.value];
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
