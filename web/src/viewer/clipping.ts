import * as THREE from "three";

/** The planes of anatomy, and no cut. */
export type CutKind = "none" | "sagittal" | "coronal" | "transverse";

export interface Cut {
  kind: CutKind;
  /** Where it lies, 0 to 1 from one end of the scene to the other. */
  fraction: number;
  /** Which side is taken away. */
  flipped: boolean;
}

const normals: Record<Exclude<CutKind, "none">, THREE.Vector3> = {
  sagittal: new THREE.Vector3(1, 0, 0),
  coronal: new THREE.Vector3(0, 1, 0),
  transverse: new THREE.Vector3(0, 0, -1),
};

/** The plane of a cut through a scene within `box`: what it looks away from is taken away. */
export function clippingPlane({ kind, fraction, flipped }: Cut, box: THREE.Box3): THREE.Plane | undefined {
  if (kind === "none") return undefined;
  const normal = normals[kind].clone();
  const at = new THREE.Vector3().lerpVectors(box.min, box.max, fraction);
  if (flipped) normal.negate();
  return new THREE.Plane().setFromNormalAndCoplanarPoint(normal, at);
}

/** Where it lies along its axis [m]. */
export function planeCoordinate({ kind, fraction }: Cut, box: THREE.Box3): number {
  const axis = ({ sagittal: "x", coronal: "y", transverse: "z", none: "x" } as const)[kind];
  return THREE.MathUtils.lerp(box.min[axis], box.max[axis], fraction);
}
