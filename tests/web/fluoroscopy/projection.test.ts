import { expect, test } from "vitest";
import type { Absorber } from "../../../web/src/fluoroscopy/absorbers";
import { angleName, isMirrored, pictureOf, projectionOf, sideLetters } from "../../../web/src/fluoroscopy/c_arm";
import { projectOnProcessor } from "../../../web/src/fluoroscopy/cpu_projection";
import { sumFormat } from "../../../web/src/fluoroscopy/gpu_projection";
import { ball } from "./ball";

const size = 64;
const pa = { lao: 0, cranial: 0, sourceToDetector: undefined };

function absorber(radius: number, weight: number): Absorber {
  return { name: "ball", ...ball(radius), weight, pose: undefined, moving: false };
}

/** The chord of the ray through the middle of a pixel [m]. */
function chord(row: number, column: number, radius: number, source: number, halfWidth: number): number {
  const at = (pixel: number) => ((pixel + 0.5) / size) * 2 * halfWidth - halfWidth;
  let miss = Math.hypot(at(row), at(column));
  if (source > 0) miss *= source / Math.hypot(source, miss);
  return miss < radius ? 2 * Math.sqrt(radius ** 2 - miss ** 2) : 0;
}

test.each([
  ["parallel rays", pa],
  ["a cone", { ...pa, sourceToDetector: 1.2 }],
  ["a turned cone", { lao: 40, cranial: -20, sourceToDetector: 1.8 }],
])("ABallHasItsChordsWith %s", (_, arm) => {
  const at = projectionOf(arm, [0, 0, 0]);
  const sums = projectOnProcessor([absorber(0.1, 1)], at, size);
  sums.forEach((sum, i) => {
    const wanted = chord(Math.floor(i / size), i % size, 0.1, at.sourceDistance, at.halfWidth);
    expect(Math.abs(sum - wanted)).toBeLessThan(wanted > 0.06 ? 0.01 * wanted : 0.006);
  });
});

test("ABodyInAnotherReplacesIt", () => {
  const at = projectionOf(pa, [0, 0, 0]);
  const sums = projectOnProcessor([absorber(0.1, 20), absorber(0.05, 5 - 20)], at, size);
  expect(sums[(size / 2) * size + size / 2]).toBeCloseTo(20 * 0.1 + 5 * 0.1, 1);
  expect(Math.min(...sums)).toBeGreaterThan(-1e-6);
});

test("APoseMovesASurface", () => {
  const at = projectionOf(pa, [0, 0, 0]);
  const pose = new Float32Array([0, 0, 0, 1, 0.1, 0, 0.05]);
  const sums = projectOnProcessor([{ ...absorber(0.03, 1), pose }], at, size);
  const [x, y] = pictureOf([0.1, 0, 0.05], at);
  const [column, row] = [Math.floor(((x + 1) / 2) * size), Math.floor(((1 - y) / 2) * size)];
  expect(sums[row * size + column]).toBeCloseTo(0.06, 2);
});

test("ThePatientsLeftIsOnTheRightAndAPIsMirrored", () => {
  const picture = (arm: typeof pa) => pictureOf([0.1, 0, 0], projectionOf(arm, [0, 0, 0]), isMirrored(arm))[0];
  expect(picture(pa)).toBeGreaterThan(0.4);
  expect(picture({ ...pa, lao: 180 })).toBeGreaterThan(0.4);
  expect(sideLetters(pa)).toEqual(["R", "L"]);
  expect(sideLetters({ ...pa, lao: 180 })).toEqual(["R", "L"]);
  expect(sideLetters({ ...pa, lao: 90 })).toEqual(["A", "P"]);
  expect(sideLetters({ ...pa, lao: -90 })).toEqual(["P", "A"]);
  expect(sideLetters({ ...pa, lao: -30 })).toEqual(["R", "L"]);
});

test("WhatIsNearTheDetectorIsSmaller", () => {
  const at = projectionOf({ ...pa, sourceToDetector: 1 }, [0, 0, 0]);
  expect(pictureOf([0.1, -0.1, 0], at)[0]).toBeLessThan(pictureOf([0.1, 0.1, 0], at)[0]);
});

test("AnglesHaveTheNamesOfRadiologists", () => {
  expect(angleName({ lao: 0, cranial: 0 })).toBe("PA");
  expect(angleName({ lao: 90, cranial: 0 })).toBe("Left lateral");
  expect(angleName({ lao: -45, cranial: 15 })).toBe("RAO 45°, cranial 15°");
  expect(angleName({ lao: 180, cranial: -10 })).toBe("AP, caudal 10°");
});

test("SumsHaveThePrecisionThatTheBrowserHas", () => {
  const gl = (...known: string[]) => ({
    getExtension: (name: string) => (known.includes(name) ? {} : null),
    R32F: 1,
    RGBA16F: 2,
  });
  const format = (...known: string[]) => sumFormat(gl(...known) as unknown as WebGL2RenderingContext);
  expect(format("EXT_color_buffer_float", "EXT_float_blend")).toEqual({ internal: 1, words: "full" });
  expect(format("EXT_color_buffer_float")).toEqual({ internal: 2, words: "half" });
  expect(format("EXT_color_buffer_half_float")).toEqual({ internal: 2, words: "half" });
  expect(format("EXT_float_blend")).toBeUndefined();
});
