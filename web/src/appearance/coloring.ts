import type { Body, FrameArrays } from "../geometry/bodies";
import type { Forces } from "../session/force_queries";
import { Signal } from "../state/signal";
import { ColorScale, topFor } from "./color_scale";
import { type FieldKind, forceOf, infoOf } from "./fields";
import { Painter } from "./vertex_colorizer";

/** Colours the moving tissue by a field of it, on a scale that stays as it is until somebody changes it. */
export class Coloring {
  /** What is coloured by; nothing where bodies have their own colours. */
  readonly kind = new Signal<FieldKind | undefined>(undefined);
  readonly scale = new Signal<ColorScale | undefined>(undefined);
  /** Why there are no colours, where there are none. */
  readonly note = new Signal("");
  private readonly painter: Painter;
  /** The scale is to be fitted once there are values. */
  private unfitted = false;

  constructor(forces: Forces) {
    this.painter = new Painter(forces);
    forces.sizes.subscribe((sizes) => {
      if (this.unfitted && sizes.size > 0) this.fit();
    });
  }

  /** Names of the bodies that are coloured. */
  get names(): string[] {
    return this.painter.names;
  }

  /** Another scene: its deformable bodies. */
  start(bodies: Body[]): void {
    this.painter.start(bodies);
  }

  receive(time: number, arrays: FrameArrays): void {
    if (this.kind.value !== undefined) this.painter.receive(time, arrays);
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
    this.setTop(topFor(this.painter.largest(info.kind), info.least));
  }

  setTop(top: number): void {
    const info = infoOf(this.kind.value);
    if (info !== undefined && top > 0) this.scale.set(new ColorScale(top, info.unit, info.diverging));
  }

  /** Colours of the vertices of each body that is coloured, sRGB. */
  paint(): Map<string, Uint8Array> {
    return this.painter.paint(this.kind.value, this.scale.value);
  }
}
