import * as THREE from "three";

/** Current positions, x y z per vertex [m], and triangles of a body; a network has no triangles. */
export interface Pickable {
  positions: ArrayLike<number>;
  triangles: ArrayLike<number>;
}

/** A vertex of one of several bodies. */
export interface Picked {
  body: number;
  vertex: number;
  position: THREE.Vector3;
}

/** Picking radius beside a surface, as a fraction of the view's height. */
const pickRadius = 0.03;

/**
 * Returns the vertex under the pointer (-1 to 1 from left to right and from bottom to top): the corner nearest to the
 * hit point of the front triangle, or the nearest vertex within the picking radius. Clipped parts are ignored.
 */
export function pickVertex(
  pointer: THREE.Vector2,
  camera: THREE.Camera,
  bodies: Pickable[],
  cut?: THREE.Plane,
): Picked | undefined {
  const caster = new THREE.Raycaster();
  caster.setFromCamera(pointer, camera);
  return onSurface(caster.ray, bodies, cut) ?? nearestToPointer(pointer, camera, bodies, cut);
}

/** True if the position is clipped. */
function isClipped(place: THREE.Vector3, cut: THREE.Plane | undefined): boolean {
  return cut !== undefined && cut.distanceToPoint(place) < 0;
}

function onSurface(ray: THREE.Ray, bodies: Pickable[], cut: THREE.Plane | undefined): Picked | undefined {
  const corners = [new THREE.Vector3(), new THREE.Vector3(), new THREE.Vector3()] as const;
  const hit = new THREE.Vector3();
  let nearest = Infinity;
  let found: Picked | undefined;
  bodies.forEach(({ positions, triangles }, body) => {
    for (let t = 0; t < triangles.length; t += 3) {
      corners.forEach((corner, i) => corner.fromArray(positions, 3 * triangles[t + i]));
      if (ray.intersectTriangle(...corners, false, hit) === null || isClipped(hit, cut)) continue;
      const distance = hit.distanceTo(ray.origin);
      if (distance >= nearest) continue;
      nearest = distance;
      const away = corners.map((corner) => corner.distanceTo(hit));
      const i = away.indexOf(Math.min(...away));
      found = { body, vertex: triangles[t + i], position: corners[i].clone() };
    }
  });
  return found;
}

function nearestToPointer(
  pointer: THREE.Vector2,
  camera: THREE.Camera,
  bodies: Pickable[],
  cut: THREE.Plane | undefined,
): Picked | undefined {
  const aspect = camera instanceof THREE.PerspectiveCamera ? camera.aspect : 1;
  const place = new THREE.Vector3();
  let nearest = 2 * pickRadius;
  let found: Picked | undefined;
  bodies.forEach(({ positions }, body) => {
    for (let i = 0; i < positions.length; i += 3) {
      if (isClipped(place.fromArray(positions, i), cut)) continue;
      place.project(camera);
      const distance = Math.hypot(aspect * (place.x - pointer.x), place.y - pointer.y);
      if (distance >= nearest) continue;
      nearest = distance;
      found = { body, vertex: i / 3, position: new THREE.Vector3().fromArray(positions, i) };
    }
  });
  return found;
}

/** Returns the intersection of the pointer ray with the plane through `place` that is parallel to the screen. */
export function dragPoint(pointer: THREE.Vector2, camera: THREE.Camera, place: THREE.Vector3): THREE.Vector3 {
  const caster = new THREE.Raycaster();
  caster.setFromCamera(pointer, camera);
  const plane = new THREE.Plane().setFromNormalAndCoplanarPoint(camera.getWorldDirection(new THREE.Vector3()), place);
  return caster.ray.intersectPlane(plane, new THREE.Vector3()) ?? place.clone();
}

/** Returns the pointer position of an event: -1 to 1 from left to right and from bottom to top. */
export function pointerOf(
  { offsetX, offsetY }: Pick<PointerEvent, "offsetX" | "offsetY">,
  canvas: HTMLElement,
): THREE.Vector2 {
  const { clientWidth, clientHeight } = canvas;
  return new THREE.Vector2((2 * offsetX) / clientWidth - 1, 1 - (2 * offsetY) / clientHeight);
}
