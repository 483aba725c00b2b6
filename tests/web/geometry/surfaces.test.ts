import * as THREE from "three";
import { mergeVertices } from "three/addons/utils/BufferGeometryUtils.js";
import { expect, test } from "vitest";
import { edgesOf } from "../../../web/src/geometry/edges";
import { computeNormals } from "../../../web/src/geometry/normals";
import { tendonWeights } from "../../../web/src/geometry/tendon";

const loose = new THREE.IcosahedronGeometry(1, 4).deleteAttribute("normal").deleteAttribute("uv");
const sphere = mergeVertices(loose);

test("NormalsOfASpherePointOutward", () => {
  const positions = sphere.getAttribute("position").array as Float32Array;
  const triangles = Uint32Array.from(sphere.getIndex()!.array);
  const normals = new Float32Array(positions.length);
  computeNormals(positions, triangles, normals);
  for (let i = 0; i < positions.length; i += 3) {
    const cosine = [0, 1, 2].reduce((sum, k) => sum + normals[i + k] * positions[i + k], 0);
    expect(cosine).toBeGreaterThan(0.999);
  }
});

test("AVertexWithoutATriangleHasNoNormalButIsFinite", () => {
  const normals = new Float32Array(3).fill(5);
  computeNormals(new Float32Array(3), new Uint32Array(), normals);
  expect([...normals]).toEqual([0, 0, 0]);
});

test("EdgesOfATetrahedronAreUnique", () => {
  const edges = edgesOf(new Uint32Array([0, 2, 1, 0, 1, 3, 1, 2, 3, 0, 3, 2]), 4);
  expect([...edges]).toEqual([0, 1, 0, 2, 0, 3, 1, 2, 1, 3, 2, 3]);
});

test("TendonWeightsDecreaseWithDistance", () => {
  const chain = new Uint32Array([0, 1, 1, 2, 2, 3, 3, 4]);
  const weights = tendonWeights(new Uint32Array([0, 1]), chain, 5, 2);
  expect(weights[0]).toBeGreaterThan(weights[2]);
  expect(weights[2]).toBeGreaterThan(weights[3]);
  expect(weights[4]).toBe(0);
});
