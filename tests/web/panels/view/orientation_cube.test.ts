import * as THREE from "three";
import { expect, test } from "vitest";
import { OrientationCube } from "../../../../web/src/panels/view/orientation_cube";

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
