import { type Body, type FrameArrays, positionsOf } from "../geometry/bodies";
import { areaChanges, displacements, speeds } from "../geometry/deformation";
import { principalStrains } from "../geometry/strain";
import { forceKindLabel } from "../session/force_queries";

/** What a body's surface can be coloured by: what its shape tells, or a kind of force that the server tells. */
export type FieldKind = ShapeKind | `force:${string}`;
export type ShapeKind = "displacement" | "speed" | "area" | "largest" | "smallest";

export interface FieldInfo {
  kind: FieldKind;
  label: string;
  unit: string;
  help: string;
  /** Both signs mean something: more or less than at rest. */
  diverging: boolean;
  /** The least end of a scale, in the unit. */
  smallestTop: number;
}

export const fields: FieldInfo[] = [
  {
    kind: "displacement",
    label: "Displacement",
    unit: "mm",
    help: "How far each vertex is from where it rests",
    diverging: false,
    smallestTop: 10,
  },
  {
    kind: "speed",
    label: "Speed",
    unit: "mm/s",
    help: "How fast each vertex moves",
    diverging: false,
    smallestTop: 10,
  },
  {
    kind: "area",
    label: "Area change",
    unit: "%",
    help: "How much larger than at rest the triangles around each vertex are",
    diverging: true,
    smallestTop: 5,
  },
  {
    kind: "largest",
    label: "Strain, largest",
    unit: "%",
    help: "How much the surface is stretched where it is stretched most: the larger principal strain",
    diverging: true,
    smallestTop: 5,
  },
  {
    kind: "smallest",
    label: "Strain, smallest",
    unit: "%",
    help: "How much the surface is stretched, or shortened, the other way: the smaller principal strain",
    diverging: true,
    smallestTop: 5,
  },
];

/** Whether neighbours' distances count in a field, so that an error of 0.1 mm would show. */
export function needsExactPositions(kind: FieldKind | undefined): boolean {
  return kind === "area" || kind === "largest" || kind === "smallest";
}

/** The kind of force that a field is, if it is one. */
export function forceKindOf(kind: FieldKind | undefined): string | undefined {
  return kind?.startsWith("force:") ? kind.slice("force:".length) : undefined;
}

export function fieldInfo(kind: FieldKind | undefined): FieldInfo | undefined {
  const force = forceKindOf(kind);
  if (kind === undefined || force === undefined) return fields.find((each) => each.kind === kind);
  const label = `Force: ${forceKindLabel(force)}`;
  return { kind, label, unit: "N", help: "How large it is on each vertex", diverging: false, smallestTop: 1e-4 };
}

/** The fields of bodies as they move; of speed it remembers the moment before. */
export class SurfaceFields {
  private last: { time: number; arrays: FrameArrays } | undefined;
  private before: { time: number; arrays: FrameArrays } | undefined;

  /** Takes note of a moment [s]. */
  receive(time: number, arrays: FrameArrays): void {
    if (this.last?.arrays === arrays) return;
    this.before = this.last !== undefined && this.last.time < time ? this.last : undefined;
    this.last = { time, arrays };
  }

  of(kind: ShapeKind, body: Body): Float32Array | undefined {
    if (this.last === undefined) return undefined;
    const now = positionsOf(body, this.last.arrays);
    if (kind === "displacement") return displacements(body.rest, now);
    if (kind === "largest" || kind === "smallest") return principalStrains(body.rest, now, body.triangles, kind);
    if (kind === "area") return areaChanges(body.rest, now, body.triangles);
    if (this.before === undefined) return new Float32Array(body.rest.length / 3);
    return speeds(positionsOf(body, this.before.arrays), now, this.last.time - this.before.time);
  }

  clear(): void {
    this.last = this.before = undefined;
  }
}
