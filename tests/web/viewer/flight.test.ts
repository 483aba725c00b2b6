import * as THREE from "three";
import { describe, expect, test } from "vitest";
import { flightAt } from "../../../web/src/viewer/flight";

const from = { eye: new THREE.Vector3(0, -2, 1), target: new THREE.Vector3(0, 0, 1) };
const to = { eye: new THREE.Vector3(0.001, 4, 0.2), target: new THREE.Vector3(0.1, 0, 1.2) };

describe("a flight", () => {
  test("StartsAndEndsAtItsViews", () => {
    expect(flightAt(from, to, 0).eye.distanceTo(from.eye)).toBeLessThan(1e-9);
    expect(flightAt(from, to, 0).target.distanceTo(from.target)).toBeLessThan(1e-9);
    expect(flightAt(from, to, 1).eye.equals(to.eye)).toBe(true);
  });

  test("KeepsItsDistanceFromThePatient", () => {
    const shortest = Math.min(from.eye.distanceTo(from.target), to.eye.distanceTo(to.target));
    for (let part = 0; part <= 1; part += 0.05) {
      const { eye, target } = flightAt(from, to, part);
      expect(eye.distanceTo(target)).toBeGreaterThan(shortest - 1e-9);
    }
  });

  test("IsSmooth", () => {
    let before = flightAt(from, to, 0).eye;
    for (let part = 0.01; part < 1; part += 0.01) {
      const { eye } = flightAt(from, to, part);
      expect(eye.distanceTo(before)).toBeLessThan(0.25);
      before = eye;
    }
  });
});
