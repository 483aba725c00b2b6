import * as THREE from "three";

/** The anatomical planes, or no clipping. */
export const cutKinds = ["none", "sagittal", "coronal", "transverse"] as const;
export type CutKind = (typeof cutKinds)[number];

/** A cut through the scene by an anatomical plane. */
export interface Cut {
  kind: CutKind;
  /** Position of the plane, 0 to 1 across the scene. */
  fraction: number;
  /** Selects the side that is clipped. */
  flipped: boolean;
}

const normals: Record<Exclude<CutKind, "none">, THREE.Vector3> = {
  sagittal: new THREE.Vector3(1, 0, 0),
  coronal: new THREE.Vector3(0, 1, 0),
  transverse: new THREE.Vector3(0, 0, -1),
};

/** Returns the clipping plane through a scene within `box`; its negative side is clipped. */
export function clippingPlane({ kind, fraction, flipped }: Cut, box: THREE.Box3): THREE.Plane | undefined {
  if (kind === "none") return undefined;
  const normal = normals[kind].clone();
  const at = new THREE.Vector3().lerpVectors(box.min, box.max, fraction);
  if (flipped) normal.negate();
  return new THREE.Plane().setFromNormalAndCoplanarPoint(normal, at);
}

/** Returns the coordinate of the plane along its axis [m]. */
export function planeCoordinate({ kind, fraction }: Cut, box: THREE.Box3): number {
  const axis = ({ sagittal: "x", coronal: "y", transverse: "z", none: "x" } as const)[kind];
  return THREE.MathUtils.lerp(box.min[axis], box.max[axis], fraction);
}
