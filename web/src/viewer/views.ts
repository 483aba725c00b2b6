import * as THREE from "three";

/** Views by name. The frame is the patient's: +x left, +y posterior, +z up, so that "front" has the left on the right. */
export type ViewName = "home" | "front" | "left" | "top";

const directions: Record<ViewName, [number, number, number]> = {
  home: [0.36, -1, 0.2],
  front: [0, -1, 0],
  left: [1, 0, 0],
  // Not quite vertical: the camera must know which way is up.
  top: [0, -0.001, 1],
};

/** Where the camera stands to see the whole of `box` from the view's side. */
export function standpoint(view: ViewName, box: THREE.Box3, camera: THREE.PerspectiveCamera): THREE.Vector3 {
  const away = new THREE.Vector3(...directions[view]).normalize();
  const right = new THREE.Vector3(-away.y, away.x, 0).normalize();
  const up = new THREE.Vector3().crossVectors(away, right);
  const size = box.getSize(new THREE.Vector3());
  const extent = (axis: THREE.Vector3) =>
    (Math.abs(axis.x) * size.x + Math.abs(axis.y) * size.y + Math.abs(axis.z) * size.z) / 2;
  const slope = Math.tan(THREE.MathUtils.degToRad(camera.fov / 2));
  const distance = Math.max(extent(up) / slope, extent(right) / (slope * camera.aspect)) * 1.06 + extent(away) * 0.8;
  return box.getCenter(new THREE.Vector3()).addScaledVector(away, distance);
}

const letters = { x: ["R", "L"], y: ["A", "P"], z: ["I", "S"] };

/** The anatomical letter for the way `direction` points, as on a radiologist's screen: L, R, A, P, S or I. */
export function letterOf(direction: THREE.Vector3): string {
  const axes = ["x", "y", "z"] as const;
  const axis = axes.reduce((best, each) => (Math.abs(direction[each]) > Math.abs(direction[best]) ? each : best));
  return letters[axis][direction[axis] > 0 ? 1 : 0];
}
