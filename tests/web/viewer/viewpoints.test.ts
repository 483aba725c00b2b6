import * as THREE from "three";
import { describe, expect, test } from "vitest";
import type { Body } from "../../../web/src/geometry/bodies";
import { planeCoordinate } from "../../../web/src/viewer/clipping";
import { viewpointKeys, viewpoints } from "../../../web/src/viewer/viewpoints";

const body = (name: string, rest: number[]) => ({ name, rest: Float32Array.from(rest) }) as Body;
const diaphragm = body("diaphragm", [-0.09, 0, 0.1, -0.05, 0.01, 0.22, 0, -0.03, 0.2, 0.06, 0.03, 0.21, 0.09, 0, 0.1]);
const vertebra = body("t10", [0, 0.05, 0.14, 0, 0.05, 0.18]);
const box = new THREE.Box3(new THREE.Vector3(-0.1, -0.1, 0), new THREE.Vector3(0.1, 0.1, 0.4));

describe("the viewpoints of a thorax", () => {
  const all = viewpoints([diaphragm, vertebra], box);
  const cutOf = (name: string) => all.find((each) => each.name === name)!.cut!;

  test("HaveAKeyAndALabelEach", () => {
    expect(all.map(({ key, label }) => [key, label])).toEqual(viewpointKeys);
    expect(new Set(viewpointKeys.map(([key]) => key)).size).toBe(10);
  });

  test("CutThroughTheDomesAndTheVertebra", () => {
    expect(planeCoordinate(cutOf("coronal"), box)).toBeCloseTo(0.02, 6);
    expect(planeCoordinate(cutOf("sagittal"), box)).toBeCloseTo(-0.05, 6);
    expect(planeCoordinate(cutOf("transverse"), box)).toBeCloseTo(0.16, 6);
  });
});

test("AnotherSceneHasTheViewpointsWithoutCuts", () => {
  const all = viewpoints([body("cube", [0, 0, 0])], box);
  expect(all).toHaveLength(7);
  expect(all.every(({ cut }) => cut === undefined)).toBe(true);
});
