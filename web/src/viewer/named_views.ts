import * as THREE from "three";

/**
 * Named views in the patient frame: +x left, +y posterior, +z superior. The "front" view has the patient's left on the
 * right.
 */
export const viewNames = ["home", "front", "back", "left", "right", "top", "bottom"] as const;
export type ViewName = (typeof viewNames)[number];

const directions: Record<ViewName, [number, number, number]> = {
  home: [0.36, -1, 0.2],
  front: [0, -1, 0],
  back: [0, 1, 0],
  left: [1, 0, 0],
  right: [-1, 0, 0],
  // Not exactly vertical, since the camera needs an up direction.
  top: [0, -0.001, 1],
  bottom: [0, -0.001, -1],
};

/**
 * Returns the initial view of a scene: perpendicular to the plane of a planar scene, otherwise from the front and
 * slightly to the side.
 */
export function openingView(box: THREE.Box3): ViewName {
  const size = box.getSize(new THREE.Vector3());
  const thin = 0.02 * Math.max(size.x, size.y, size.z);
  if (size.z < thin) return "top";
  if (size.y < thin) return "front";
  return size.x < thin ? "left" : "home";
}

/** Returns the horizontal and vertical axis of a planar scene; undefined for other scenes. */
export function planeAxes(box: THREE.Box3): ["x" | "y", "y" | "z"] | undefined {
  const view = openingView(box);
  if (view === "top") return ["x", "y"];
  if (view === "front") return ["x", "z"];
  return view === "left" ? ["y", "z"] : undefined;
}

/** Fraction of the canvas' width and height that the scene may fill, 0 to 1. */
export interface FreeArea {
  width: number;
  height: number;
}

/** Returns the camera position that shows all of `points`, looking at `center` from the view's side. */
export function cameraPosition(
  view: ViewName,
  points: THREE.Vector3[],
  center: THREE.Vector3,
  camera: THREE.PerspectiveCamera,
  free: FreeArea = { width: 1, height: 1 },
): THREE.Vector3 {
  const away = new THREE.Vector3(...directions[view]).normalize();
  const right = new THREE.Vector3(-away.y, away.x, 0).normalize();
  const up = new THREE.Vector3().crossVectors(away, right);
  const slope = Math.tan(THREE.MathUtils.degToRad(camera.fov / 2));
  const offset = new THREE.Vector3();
  let distance = 0;
  for (const point of points) {
    offset.subVectors(point, center);
    const across = Math.abs(offset.dot(right)) / (slope * camera.aspect * free.width);
    const along = Math.abs(offset.dot(up)) / (slope * free.height);
    distance = Math.max(distance, offset.dot(away) + Math.max(across, along));
  }
  return center.clone().addScaledVector(away, margin * distance);
}

const margin = 1.04;

const letters = { x: ["R", "L"], y: ["A", "P"], z: ["I", "S"] };

/** Returns the anatomical letter of a direction: L, R, A, P, S or I. */
export function directionLetter(direction: THREE.Vector3): string {
  const axes = ["x", "y", "z"] as const;
  const axis = axes.reduce((best, each) => (Math.abs(direction[each]) > Math.abs(direction[best]) ? each : best));
  return letters[axis][direction[axis] > 0 ? 1 : 0];
}
