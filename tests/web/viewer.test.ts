import * as THREE from "three";
import { mergeVertices } from "three/addons/utils/BufferGeometryUtils.js";
import { describe, expect, test } from "vitest";
import { edgesOf } from "../../web/src/viewer/edges";
import { computeNormals } from "../../web/src/viewer/normals";
import { tendonWeights } from "../../web/src/viewer/tendon";
import { letterOf, standpoint } from "../../web/src/viewer/views";

const loose = new THREE.IcosahedronGeometry(1, 4)
  .deleteAttribute("normal")
  .deleteAttribute("uv");
const sphere = mergeVertices(loose);

test("NormalsOfASpherePointOutward", () => {
  const positions = sphere.getAttribute("position").array as Float32Array;
  const triangles = Uint32Array.from(
    { length: positions.length / 3 },
    (_, i) => i,
  );
  const normals = new Float32Array(positions.length);
  computeNormals(positions, triangles, normals);
  for (let i = 0; i < positions.length; i += 3) {
    const cosine = [0, 1, 2].reduce(
      (sum, k) => sum + normals[i + k] * positions[i + k],
      0,
    );
    expect(cosine).toBeGreaterThan(0.99);
  }
});

test("AVertexWithoutATriangleHasNoNormalButIsFinite", () => {
  const normals = new Float32Array(3).fill(5);
  computeNormals(new Float32Array(3), new Uint32Array(), normals);
  expect([...normals]).toEqual([0, 0, 0]);
});

test("EachEdgeOfATetrahedronComesOnce", () => {
  const edges = edgesOf(
    new Uint32Array([0, 2, 1, 0, 1, 3, 1, 2, 3, 0, 3, 2]),
    4,
  );
  expect([...edges]).toEqual([0, 1, 0, 2, 0, 3, 1, 2, 1, 3, 2, 3]);
});

test("TendonFadesFromItsLinksOutward", () => {
  const chain = new Uint32Array([0, 1, 1, 2, 2, 3, 3, 4]);
  const weights = tendonWeights(new Uint32Array([0, 1]), chain, 5, 2);
  expect(weights[0]).toBeGreaterThan(weights[2]);
  expect(weights[2]).toBeGreaterThan(weights[3]);
  expect(weights[4]).toBe(0);
});

describe("views", () => {
  const camera = new THREE.PerspectiveCamera(26, 1.5);
  const box = new THREE.Box3(
    new THREE.Vector3(-0.15, -0.1, 1),
    new THREE.Vector3(0.15, 0.1, 1.4),
  );

  test("FromTheFrontThePatientsLeftIsOnTheRight", () => {
    camera.up.set(0, 0, 1);
    camera.position.copy(standpoint("front", box, camera));
    camera.lookAt(box.getCenter(new THREE.Vector3()));
    camera.updateMatrixWorld();
    expect(
      letterOf(new THREE.Vector3().setFromMatrixColumn(camera.matrixWorld, 0)),
    ).toBe("L");
    expect(
      letterOf(new THREE.Vector3().setFromMatrixColumn(camera.matrixWorld, 1)),
    ).toBe("S");
  });

  test("EachShowsTheWholeBox", () => {
    for (const view of ["home", "front", "left", "top"] as const) {
      camera.position.copy(standpoint(view, box, camera));
      camera.lookAt(box.getCenter(new THREE.Vector3()));
      camera.updateMatrixWorld();
      for (let corner = 0; corner < 8; corner++) {
        const point = new THREE.Vector3(
          corner & 1 ? box.max.x : box.min.x,
          corner & 2 ? box.max.y : box.min.y,
          corner & 4 ? box.max.z : box.min.z,
        ).project(camera);
        expect(
          Math.max(Math.abs(point.x), Math.abs(point.y)),
          view,
        ).toBeLessThanOrEqual(1);
      }
    }
  });
});
