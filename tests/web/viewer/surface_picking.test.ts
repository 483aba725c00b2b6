import * as THREE from "three";
import { describe, expect, test } from "vitest";
import type { BodyView } from "../../../web/src/viewer/body_view";
import { surfaceVertex } from "../../../web/src/viewer/surface_picking";

const camera = new THREE.PerspectiveCamera(30, 1);
camera.position.set(0, 0, 5);
camera.updateMatrixWorld();
const center = new THREE.Vector2();

/** A square around the z axis; vertices are numbered along it. */
function sheet(name: string, z: number, moved = new THREE.Matrix4()): BodyView {
  const rest = Float32Array.from([-1, -1, 0, 1, -1, 0, -1, 1, 0, 1, 1, 0]);
  const group = new THREE.Group();
  group.position.setZ(z);
  group.applyMatrix4(moved);
  group.updateMatrixWorld();
  return {
    body: { name, triangles: Uint32Array.from([0, 1, 2, 1, 3, 2]) },
    group,
    positions: new THREE.BufferAttribute(rest, 3),
    restBox: new THREE.Box3().setFromArray(rest),
  } as unknown as BodyView;
}

describe("the surface under the pointer", () => {
  test("IsTheFrontOne", () => {
    const found = surfaceVertex(
      center,
      camera,
      [sheet("back", 0), sheet("front", 1), sheet("middle", 0.5)],
      1,
      undefined,
    );
    expect(found?.body).toBe("front");
  });

  test("IsNotClipped", () => {
    const below = new THREE.Plane(new THREE.Vector3(0, 0, -1), 0.7);
    expect(surfaceVertex(center, camera, [sheet("back", 0), sheet("front", 1)], 1, below)?.body).toBe("back");
  });

  test("IsFoundWhereARigidBodyIs", () => {
    const away = new THREE.Matrix4().makeTranslation(10, 0, 0);
    expect(surfaceVertex(center, camera, [sheet("front", 1, away), sheet("back", 0)], 1, undefined)?.body).toBe("back");
  });

  test("IsSeenFromBothSides", () => {
    const turned = new THREE.Matrix4().makeRotationX(Math.PI);
    expect(surfaceVertex(center, camera, [sheet("turned", 0, turned)], 1, undefined)?.body).toBe("turned");
  });

  test("IsNoneBesideAllBodies", () => {
    expect(surfaceVertex(new THREE.Vector2(0.95, 0.95), camera, [sheet("small", -9)], 1, undefined)).toBeUndefined();
  });
});
