import * as THREE from "three";
import type { VertexRef } from "../geometry/vertices";
import type { BodyView } from "./body_view";

/** How far a body moves from its box at rest, as a fraction of the scene. */
const slack = 0.12;

/**
 * Returns a vertex of the front triangle under the pointer (-1 to 1 from left to right and from bottom to top) that is
 * not clipped. Only bodies whose box the ray meets are searched: a few milliseconds for a thorax.
 */
export function surfaceVertex(
  pointer: THREE.Vector2,
  camera: THREE.Camera,
  views: readonly BodyView[],
  extent: number,
  cut: THREE.Plane | undefined,
): VertexRef | undefined {
  const caster = new THREE.Raycaster();
  caster.setFromCamera(pointer, camera);
  let nearest = Infinity;
  let found: VertexRef | undefined;
  for (const view of views) {
    const ray = caster.ray.clone().applyMatrix4(view.group.matrixWorld.clone().invert());
    if (!ray.intersectsBox(view.restBox.clone().expandByScalar(slack * extent))) continue;
    const hit = firstHit(ray, view, nearest, cut);
    if (hit === undefined) continue;
    nearest = hit.distance;
    found = { body: view.body.name, vertex: hit.vertex };
  }
  return found;
}

/** Returns the first hit nearer than `nearest` [m]. */
function firstHit(ray: THREE.Ray, view: BodyView, nearest: number, cut: THREE.Plane | undefined) {
  const { triangles } = view.body;
  const positions = view.positions.array;
  const place = new THREE.Vector3();
  let hit: { vertex: number; distance: number } | undefined;
  let limit = nearest;
  for (let t = 0; t < triangles.length; t += 3) {
    const distance = distanceTo(ray, positions, 3 * triangles[t], 3 * triangles[t + 1], 3 * triangles[t + 2]);
    if (distance >= limit) continue;
    if (cut !== undefined) {
      ray.at(distance, place).applyMatrix4(view.group.matrixWorld);
      if (cut.distanceToPoint(place) < 0) continue;
    }
    limit = distance;
    hit = { vertex: triangles[t], distance };
  }
  return hit;
}

/**
 * Returns the distance along a ray to a triangle, seen from either side; Infinity if it misses (Möller and Trumbore
 * 1997, "Fast, minimum storage ray-triangle intersection"). Plain numbers, since it runs for each triangle.
 */
function distanceTo(
  { origin: o, direction: d }: THREE.Ray,
  p: ArrayLike<number>,
  a: number,
  b: number,
  c: number,
): number {
  const [ux, uy, uz] = [p[b] - p[a], p[b + 1] - p[a + 1], p[b + 2] - p[a + 2]];
  const [vx, vy, vz] = [p[c] - p[a], p[c + 1] - p[a + 1], p[c + 2] - p[a + 2]];
  const [hx, hy, hz] = [d.y * vz - d.z * vy, d.z * vx - d.x * vz, d.x * vy - d.y * vx];
  const determinant = ux * hx + uy * hy + uz * hz;
  if (determinant === 0) return Infinity;
  const [sx, sy, sz] = [o.x - p[a], o.y - p[a + 1], o.z - p[a + 2]];
  const first = (sx * hx + sy * hy + sz * hz) / determinant;
  if (first < 0 || first > 1) return Infinity;
  const [qx, qy, qz] = [sy * uz - sz * uy, sz * ux - sx * uz, sx * uy - sy * ux];
  const second = (d.x * qx + d.y * qy + d.z * qz) / determinant;
  if (second < 0 || first + second > 1) return Infinity;
  const distance = (vx * qx + vy * qy + vz * qz) / determinant;
  return distance > 0 ? distance : Infinity;
}
