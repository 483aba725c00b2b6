import { type Body, type FrameArrays, positionsOf } from "../geometry/bodies";
import { areaChanges, displacements, speeds } from "../geometry/deformation";
import { principalStrains } from "../geometry/strain";
import type { TissueKind } from "../lungs/tissue_state";
import { forceKindLabel } from "../session/force_queries";

/**
 * A field that a surface can be coloured by: computed from its shape, the magnitude of one kind of force, or the lungs'
 * tissue, both from the server.
 */
export type FieldKind = ShapeKind | `force:${string}` | `tissue:${TissueKind}`;
/** Fields that are computed from the shape of a surface. */
export type ShapeKind = "displacement" | "speed" | "area" | "largest" | "smallest";

/** Name, unit and scale of a field. */
export interface FieldInfo {
  kind: FieldKind;
  label: string;
  unit: string;
  help: string;
  /** True if the field is signed: more or less than at rest. */
  diverging: boolean;
  /** Smallest end of the scale, in `unit`. */
  smallestTop: number;
}

/** The catalogue of shape fields. */
export const fields: FieldInfo[] = [
  {
    kind: "displacement",
    label: "Displacement",
    unit: "mm",
    help: "Distance of each vertex from its rest position",
    diverging: false,
    smallestTop: 10,
  },
  {
    kind: "speed",
    label: "Speed",
    unit: "mm/s",
    help: "Speed of each vertex",
    diverging: false,
    smallestTop: 10,
  },
  {
    kind: "area",
    label: "Area change",
    unit: "%",
    help: "Area change of the triangles around each vertex, relative to rest",
    diverging: true,
    smallestTop: 5,
  },
  {
    kind: "largest",
    label: "Largest principal strain",
    unit: "%",
    help: "Larger principal strain of the surface, relative to rest",
    diverging: true,
    smallestTop: 5,
  },
  {
    kind: "smallest",
    label: "Smallest principal strain",
    unit: "%",
    help: "Smaller principal strain of the surface, relative to rest",
    diverging: true,
    smallestTop: 5,
  },
];

/** The catalogue of fields of the lungs' tissue, relative to rest. */
export const tissueFields: FieldInfo[] = [
  {
    kind: "tissue:displacement",
    label: "Lungs: displacement",
    unit: "mm",
    help: "Distance of the lungs' tissue from where it is at rest",
    diverging: false,
    smallestTop: 10,
  },
  {
    kind: "tissue:ventilation",
    label: "Lungs: volume gained",
    unit: "%",
    help: "Ventilation: volume that the tissue gained, of its volume at rest",
    diverging: true,
    smallestTop: 10,
  },
  {
    kind: "tissue:strain",
    label: "Lungs: largest strain",
    unit: "%",
    help: "Largest principal strain of the lungs' tissue",
    diverging: true,
    smallestTop: 10,
  },
];

/** Returns the field of the lungs' tissue; undefined for other fields. */
export function tissueKindOf(kind: FieldKind | undefined): TissueKind | undefined {
  return tissueFields.some((each) => each.kind === kind) ? (kind?.slice("tissue:".length) as TissueKind) : undefined;
}

/** True if the field depends on distances between neighbours, where a position error of 0.1 mm would be visible. */
export function needsExactPositions(kind: FieldKind | undefined): boolean {
  return kind === "area" || kind === "largest" || kind === "smallest";
}

/** Returns the kind of force of a force field; undefined for other fields. */
export function forceKindOf(kind: FieldKind | undefined): string | undefined {
  return kind?.startsWith("force:") ? kind.slice("force:".length) : undefined;
}

/** Returns the description of a shape or force field; undefined without a field. */
export function fieldInfo(kind: FieldKind | undefined): FieldInfo | undefined {
  const force = forceKindOf(kind);
  if (kind === undefined || force === undefined) return [...fields, ...tissueFields].find((each) => each.kind === kind);
  const label = `Force: ${forceKindLabel(force)}`;
  return { kind, label, unit: "N", help: "Magnitude of the force on each vertex", diverging: false, smallestTop: 1e-4 };
}

/** Computes fields of the displayed frame; speed uses the frame displayed before. */
export class SurfaceFields {
  private last: { time: number; arrays: FrameArrays } | undefined;
  private before: { time: number; arrays: FrameArrays } | undefined;

  /** Sets the displayed frame at `time` [s]. */
  receive(time: number, arrays: FrameArrays): void {
    if (this.last?.arrays === arrays) return;
    this.before = this.last !== undefined && this.last.time < time ? this.last : undefined;
    this.last = { time, arrays };
  }

  /** Returns the field on each vertex of a body in its unit; undefined before the first frame. */
  of(kind: ShapeKind, body: Body): Float32Array | undefined {
    if (this.last === undefined) return undefined;
    const now = positionsOf(body, this.last.arrays);
    if (kind === "displacement") return displacements(body.rest, now);
    if (kind === "largest" || kind === "smallest") return principalStrains(body.rest, now, body.triangles, kind);
    if (kind === "area") return areaChanges(body.rest, now, body.triangles);
    if (this.before === undefined) return new Float32Array(body.rest.length / 3);
    return speeds(positionsOf(body, this.before.arrays), now, this.last.time - this.before.time);
  }

  /** Forgets the frames, for another scene. */
  clear(): void {
    this.last = this.before = undefined;
  }
}
