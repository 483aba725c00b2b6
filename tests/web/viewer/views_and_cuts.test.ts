import * as THREE from "three";
import { describe, expect, test } from "vitest";
import { clippingPlane, planeCoordinate } from "../../../web/src/viewer/clipping";
import {
  directionLetter,
  fitted,
  openingView,
  viewDirection,
  viewNames,
  type ViewName,
} from "../../../web/src/viewer/named_views";
import { pickVertex } from "../../../web/src/viewer/picking";

describe("views", () => {
  const camera = new THREE.PerspectiveCamera(26, 1.5);
  const corners = Array.from(
    { length: 8 },
    (_, i) => new THREE.Vector3(i & 1 ? 0.15 : -0.15, i & 2 ? 0.1 : -0.1, i & 4 ? 1.4 : 1),
  );
  const lookFrom = (view: ViewName, free = { width: 1, height: 1 }) => {
    const { eye, target } = fitted(viewDirection(view), corners, camera, free);
    camera.up.set(0, 0, 1);
    camera.position.copy(eye);
    camera.lookAt(target);
    camera.updateMatrixWorld();
  };

  test("FromTheFrontThePatientsLeftIsOnTheRight", () => {
    lookFrom("front");
    expect(directionLetter(new THREE.Vector3().setFromMatrixColumn(camera.matrixWorld, 0))).toBe("L");
    expect(directionLetter(new THREE.Vector3().setFromMatrixColumn(camera.matrixWorld, 1))).toBe("S");
  });

  test("EachFillsTheFreeAreaAndKeepsWithinIt", () => {
    for (const view of viewNames) {
      lookFrom(view, { width: 0.6, height: 0.8 });
      const seen = corners.map((corner) => corner.clone().project(camera));
      const across = seen.map(({ x }) => x / 0.6);
      const along = seen.map(({ y }) => y / 0.8);
      for (const share of [...across, ...along]) expect(Math.abs(share), view).toBeLessThanOrEqual(1);
      const span = (shares: number[]) => (Math.max(...shares) - Math.min(...shares)) / 2;
      expect(Math.max(span(across), span(along)), view).toBeGreaterThan(0.93);
    }
  });

  test("ASceneWithoutRibsOpensFromAbove", () => {
    const box = new THREE.Box3(new THREE.Vector3(), new THREE.Vector3(1, 1, 1));
    expect(viewDirection(openingView(box, false)).z).toBeGreaterThan(0);
  });

  test("TheFirstIsFromThePatientsRightAndSlightlyBelow", () => {
    const { x, y, z } = viewDirection("home");
    expect([Math.sign(x), Math.sign(y), Math.sign(z)]).toEqual([-1, -1, -1]);
    expect(Math.abs(z)).toBeLessThan(Math.sin(Math.PI / 9));
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
