import type { Body, FrameArrays } from "../geometry/bodies";
import type { LungTissue } from "../lungs/lung_tissue";
import type { ForceQueries } from "../session/force_queries";
import { Signal } from "../state/signal";
import { ColorScale, niceTop } from "./color_scale";
import { fieldInfo, type FieldKind, forceKindOf, tissueKindOf } from "./fields";
import { VertexColorizer } from "./vertex_colorizer";

/** Colours deformable bodies, or the lungs, by a field. The scale stays fixed until it is fitted or set. */
export class Coloring {
  /** The field; undefined if bodies have their own colours. */
  readonly field = new Signal<FieldKind | undefined>(undefined);
  readonly scale = new Signal<ColorScale | undefined>(undefined);
  /** Explains why there are no colours; otherwise empty. */
  readonly message = new Signal("");
  private readonly colorizer: VertexColorizer;
  /** True until the scale has been fitted to values, which arrive later for forces and tissue. */
  private needsFit = false;

  constructor(forces: ForceQueries, lungs?: LungTissue) {
    this.colorizer = new VertexColorizer(forces, lungs);
    forces.magnitudes.subscribe((sizes) => {
      if (this.needsFit && sizes.size > 0) this.fit();
    });
  }

  /** Names of the coloured bodies. */
  get bodyNames(): string[] {
    return this.colorizer.bodyNames;
  }

  /** Starts another scene with these deformable bodies. */
  start(bodies: Body[]): void {
    this.colorizer.start(bodies);
  }

  /** Sets the displayed frame at `time` [s]. */
  receive(time: number, arrays: FrameArrays): void {
    if (this.field.value !== undefined) this.colorizer.receive(time, arrays);
  }

  /** Selects a field and fits the scale to it; undefined restores the bodies' own colours. */
  choose(kind: FieldKind | undefined): void {
    this.field.set(kind);
    this.fit();
    this.needsFit = forceKindOf(kind) !== undefined || tissueKindOf(kind) !== undefined;
  }

  /** Fits the scale once the values of the lungs' tissue have arrived, unless it is fitted or set. */
  fitToTissue(): void {
    const { value } = this.field;
    if (this.needsFit && value !== undefined && tissueKindOf(value) !== undefined)
      if (this.colorizer.upperBounds(value).some((bound) => bound > 0)) this.fit();
  }

  /** Ends the scale at the 99th percentile of the current values. */
  fit(): void {
    const info = fieldInfo(this.field.value);
    if (info === undefined) return this.scale.set(undefined);
    this.needsFit = false;
    this.setTop(niceTop(this.colorizer.upperBounds(info.kind), info.smallestTop));
  }

  /** Ends the scale at `top`, in the unit of the field; ignores values that are not positive. */
  setTop(top: number): void {
    const info = fieldInfo(this.field.value);
    if (info !== undefined && top > 0) this.scale.set(new ColorScale(top, info.unit, info.diverging));
  }

  /** Returns the vertex colours of each coloured body as sRGB bytes. */
  colors(): Map<string, Uint8Array> {
    return this.colorizer.colors(this.field.value, this.scale.value);
  }
}
