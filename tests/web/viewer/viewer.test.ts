import * as THREE from "three";
import { mergeVertices } from "three/addons/utils/BufferGeometryUtils.js";
import { describe, expect, test } from "vitest";
import { edgesOf } from "../../../web/src/geometry/edges";
import { computeNormals } from "../../../web/src/geometry/normals";
import { tendonWeights } from "../../../web/src/geometry/tendon";
import { OrientationCube } from "../../../web/src/panels/view/orientation_cube";
import { AdaptiveResolution } from "../../../web/src/viewer/adaptive_resolution";
import { clippingPlane, planeCoordinate } from "../../../web/src/viewer/clipping";
import { cameraPosition, directionLetter, openingView, type ViewName } from "../../../web/src/viewer/named_views";
import { pickVertex } from "../../../web/src/viewer/picking";

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

describe("views", () => {
  const camera = new THREE.PerspectiveCamera(26, 1.5);
  const center = new THREE.Vector3(0, 0, 1.2);
  const corners = Array.from(
    { length: 8 },
    (_, i) => new THREE.Vector3(i & 1 ? 0.15 : -0.15, i & 2 ? 0.1 : -0.1, i & 4 ? 1.4 : 1),
  );
  const lookFrom = (view: ViewName, free = { width: 1, height: 1 }) => {
    camera.up.set(0, 0, 1);
    camera.position.copy(cameraPosition(view, corners, center, camera, free));
    camera.lookAt(center);
    camera.updateMatrixWorld();
  };

  test("FromTheFrontThePatientsLeftIsOnTheRight", () => {
    lookFrom("front");
    expect(directionLetter(new THREE.Vector3().setFromMatrixColumn(camera.matrixWorld, 0))).toBe("L");
    expect(directionLetter(new THREE.Vector3().setFromMatrixColumn(camera.matrixWorld, 1))).toBe("S");
  });

  test("EachFitsTheSceneIntoTheFreeArea", () => {
    for (const view of ["home", "front", "left", "top"] as const) {
      lookFrom(view, { width: 0.6, height: 0.8 });
      for (const corner of corners) {
        const { x, y } = corner.clone().project(camera);
        expect(Math.abs(x), view).toBeLessThanOrEqual(0.6);
        expect(Math.abs(y), view).toBeLessThanOrEqual(0.8);
      }
    }
  });

  test("APlanarSceneOpensPerpendicularly", () => {
    const flat = (size: [number, number, number]) =>
      openingView(new THREE.Box3(new THREE.Vector3(), new THREE.Vector3(...size)));
    expect([flat([1, 1, 0]), flat([1, 0, 1]), flat([0, 1, 1]), flat([1, 1, 1])]).toEqual([
      "top",
      "front",
      "left",
      "home",
    ]);
  });
});

describe("a cut", () => {
  const box = new THREE.Box3(new THREE.Vector3(-1, -2, 0), new THREE.Vector3(1, 2, 4));

  test("ClipsOneSideOfItsPlane", () => {
    const cut = { kind: "coronal" as const, fraction: 0.25, flipped: false };
    const plane = clippingPlane(cut, box)!;
    expect(planeCoordinate(cut, box)).toBe(-1);
    expect(plane.distanceToPoint(new THREE.Vector3(0, -1.5, 0))).toBeLessThan(0);
    expect(plane.distanceToPoint(new THREE.Vector3(0, 1.5, 0))).toBeGreaterThan(0);
    const other = clippingPlane({ ...cut, flipped: true }, box)!;
    expect(other.distanceToPoint(new THREE.Vector3(0, 1.5, 0))).toBeLessThan(0);
    expect(clippingPlane({ ...cut, kind: "none" }, box)).toBeUndefined();
  });

  test("PreventsPickingOfClippedParts", () => {
    const camera = new THREE.PerspectiveCamera(26, 1);
    camera.position.set(0, 0, 5);
    camera.updateMatrixWorld();
    const sheet = (z: number) => ({ positions: [-1, -1, z, 1, -1, z, 0, 1, z], triangles: [0, 1, 2] });
    const sheets = [sheet(1), sheet(0)];
    const center = new THREE.Vector2();
    expect(pickVertex(center, camera, sheets)!.body).toBe(0);
    const below = new THREE.Plane(new THREE.Vector3(0, 0, -1), 0.5);
    expect(pickVertex(center, camera, sheets, below)!.body).toBe(1);
  });
});

test("TheCubeShowsTheVisibleSide", () => {
  const cube = new OrientationCube(() => undefined);
  const axes = [new THREE.Vector3(1, 0, 0), new THREE.Vector3(0, 0, 1), new THREE.Vector3(0, -1, 0)] as const;
  cube.show({ left: "R", right: "L", top: "S", bottom: "I", pixelsPerMetre: 1, axes: [...axes] });
  const numbers = (element: Element) =>
    (element as HTMLElement).style.transform.match(/-?[\d.]+(?=[,)])/g)!.map(Number);
  const turn = new THREE.Matrix4().fromArray(numbers(cube.element.firstElementChild!));
  for (const side of cube.element.querySelectorAll("button")) {
    const face = new THREE.Matrix4().fromArray(numbers(side)).premultiply(turn);
    // On a page, x points right, y down and z out of it.
    const out = new THREE.Vector3(0, 0, 1).transformDirection(face);
    expect(out.z > 0.9, side.textContent!).toBe(side.textContent === "A");
    if (side.textContent === "A") expect(new THREE.Vector3(0, 1, 0).transformDirection(face).y).toBeCloseTo(1, 3);
  }
});

describe("the adaptive resolution", () => {
  /** Records frames every `interval` ms for `time` ms. */
  const run = (resolution: AdaptiveResolution, start: number, interval: number, time: number, drawing = true) => {
    for (let now = start; now < start + time; now += interval) resolution.recordFrame(now, drawing);
    return start + time;
  };

  test("IsFullOnAFastMachine", () => {
    const sharpness = new AdaptiveResolution(2);
    run(sharpness, 0, 16, 10_000);
    expect(sharpness.ratio).toBe(2);
  });

  test("IsReducedDuringMotionOnASlowMachine", () => {
    const resolution = new AdaptiveResolution(2);
    const now = run(resolution, 0, 200, 10_000);
    expect(resolution.ratio).toBeLessThan(1);
    run(resolution, now, 16, 1000, false);
    expect(resolution.ratio).toBe(2);
  });
});
