import * as THREE from "three";

/**
 * Named views in the patient frame: +x left, +y posterior, +z superior. The "front" view has the patient's left on the
 * right; "abdomen" looks from the abdomen up into the domes.
 */
export const viewNames = ["home", "front", "back", "left", "right", "top", "bottom", "abdomen"] as const;
export type ViewName = (typeof viewNames)[number];
/** Side that a scene is seen from; "object" is the first view of a scene without a rib cage. */
export type Side = ViewName | "object";

const directions: Record<Side, [number, number, number]> = {
  // From the patient's right and slightly below: the domes are seen through the arch of the ribs.
  home: [-0.4, -1, -0.16],
  object: [0.36, -1, 0.2],
  front: [0, -1, 0],
  back: [0, 1, 0],
  left: [1, 0, 0],
  right: [-1, 0, 0],
  // Not exactly vertical, since the camera needs an up direction.
  top: [0, -0.001, 1],
  bottom: [0, -0.001, -1],
  abdomen: [-0.12, -0.8, -1],
};

/**
 * Returns the initial view of a scene: perpendicular to the plane of a planar scene, otherwise from the front and
 * slightly to the side; a rib cage (`caged`) is seen from below.
 */
export function openingView(box: THREE.Box3, caged = true): Side {
  const size = box.getSize(new THREE.Vector3());
  const thin = 0.02 * Math.max(size.x, size.y, size.z);
  if (size.z < thin) return "top";
  if (size.y < thin) return "front";
  if (size.x < thin) return "left";
  return caged ? "home" : "object";
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

/** Position of a camera and the point that it looks at [m]. */
export interface Outlook {
  eye: THREE.Vector3;
  target: THREE.Vector3;
}

/** Returns the unit vector from the scene to the camera of a view. */
export function viewDirection(view: Side): THREE.Vector3 {
  return new THREE.Vector3(...directions[view]).normalize();
}

/**
 * Returns the camera in this direction that shows all of `points` as large as possible and in the middle of the free
 * area. Returns the exact optimum: in the camera's frame, with z towards the camera at (cx, cy, d), a point is inside
 * if |x - cx| <= s (d - z), with s the slope of the frustum's side; so d = (max(x + s z) + max(-x + s z)) / (2 s).
 */
export function fitted(
  away: THREE.Vector3,
  points: THREE.Vector3[],
  camera: THREE.PerspectiveCamera,
  free: FreeArea = { width: 1, height: 1 },
): Outlook {
  const right = new THREE.Vector3(-away.y, away.x, 0).normalize();
  const up = new THREE.Vector3().crossVectors(away, right);
  const slope = Math.tan(THREE.MathUtils.degToRad(camera.fov / 2));
  const across = extremes(points, right, away, slope * camera.aspect * free.width);
  const along = extremes(points, up, away, slope * free.height);
  const distance = Math.max(across.distance, along.distance);
  const depths = points.map((point) => point.dot(away));
  const middle = depths.length === 0 ? 0 : (Math.min(...depths) + Math.max(...depths)) / 2;
  const axis = right.multiplyScalar(across.middle).addScaledVector(up, along.middle);
  return {
    eye: axis.clone().addScaledVector(away, middle + margin * (distance - middle)),
    target: axis.clone().addScaledVector(away, middle),
  };
}

function extremes(points: THREE.Vector3[], axis: THREE.Vector3, away: THREE.Vector3, slope: number) {
  let [high, low] = [-Infinity, -Infinity];
  for (const point of points) {
    const [x, z] = [point.dot(axis), slope * point.dot(away)];
    high = Math.max(high, x + z);
    low = Math.max(low, z - x);
  }
  return { middle: (high - low) / 2, distance: (high + low) / (2 * slope) };
}

/** Room for the breath around the scene at rest. */
const margin = 1.03;

const letters = { x: ["R", "L"], y: ["A", "P"], z: ["I", "S"] };

/** Returns the anatomical letter of a direction: L, R, A, P, S or I. */
export function directionLetter(direction: THREE.Vector3): string {
  const axes = ["x", "y", "z"] as const;
  const axis = axes.reduce((best, each) => (Math.abs(direction[each]) > Math.abs(direction[best]) ? each : best));
  return letters[axis][direction[axis] > 0 ? 1 : 0];
}
