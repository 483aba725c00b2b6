import type { Body, FrameArrays } from "../geometry/bodies";
import type { ForceQueries } from "../session/force_queries";
import { Signal } from "../state/signal";
import { ColorScale, niceTop } from "./color_scale";
import { fieldInfo, type FieldKind, forceKindOf } from "./fields";
import { VertexColorizer } from "./vertex_colorizer";

/** Colours the moving tissue by a field of it, on a scale that stays as it is until somebody changes it. */
export class Coloring {
  /** What is coloured by; nothing where bodies have their own colours. */
  readonly field = new Signal<FieldKind | undefined>(undefined);
  readonly scale = new Signal<ColorScale | undefined>(undefined);
  /** Why there are no colours, where there are none. */
  readonly message = new Signal("");
  private readonly colorizer: VertexColorizer;
  /** The scale is to be fitted once there are values. */
  private needsFit = false;

  constructor(forces: ForceQueries) {
    this.colorizer = new VertexColorizer(forces);
    forces.magnitudes.subscribe((sizes) => {
      if (this.needsFit && sizes.size > 0) this.fit();
    });
  }

  /** Names of the bodies that are coloured. */
  get bodyNames(): string[] {
    return this.colorizer.bodyNames;
  }

  /** Another scene: its deformable bodies. */
  start(bodies: Body[]): void {
    this.colorizer.start(bodies);
  }

  receive(time: number, arrays: FrameArrays): void {
    if (this.field.value !== undefined) this.colorizer.receive(time, arrays);
  }

  choose(kind: FieldKind | undefined): void {
    this.field.set(kind);
    this.fit();
    this.needsFit = forceKindOf(kind) !== undefined;
  }

  /** A scale that ends at the largest value there is now, but for one vertex in a hundred. */
  fit(): void {
    const info = fieldInfo(this.field.value);
    if (info === undefined) return this.scale.set(undefined);
    this.needsFit = false;
    this.setTop(niceTop(this.colorizer.upperBounds(info.kind), info.smallestTop));
  }

  setTop(top: number): void {
    const info = fieldInfo(this.field.value);
    if (info !== undefined && top > 0) this.scale.set(new ColorScale(top, info.unit, info.diverging));
  }

  /** Colours of the vertices of each body that is coloured, sRGB. */
  colors(): Map<string, Uint8Array> {
    return this.colorizer.colors(this.field.value, this.scale.value);
  }
}
