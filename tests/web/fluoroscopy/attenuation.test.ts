import { readFileSync } from "node:fs";
import { join } from "node:path";
import { expect, test } from "vitest";
import { Absorbers } from "../../../web/src/fluoroscopy/absorbers";
import { absorptionOf, air, lungCoefficient, lungDensity, materials } from "../../../web/src/fluoroscopy/attenuation";
import { trunkOutline } from "../../../web/src/fluoroscopy/outline";
import { greyOf, windowOf } from "../../../web/src/fluoroscopy/tone";
import { Placement } from "../../../web/src/gen/phrenic/v1/frames_pb";
import type { Body } from "../../../web/src/geometry/bodies";
import { enclosedVolume, isClosed } from "../../../web/src/geometry/measuring";
import { ball } from "./ball";

function body(name: string, radius: number, placement: Placement, firstVertex = 0): Body {
  const { vertices, triangles } = ball(radius, 12);
  const none = new Uint32Array();
  return {
    name,
    layer: name,
    layerTitle: name,
    color: "",
    opacity: 1,
    placement,
    pose: 0,
    firstVertex,
    rest: vertices,
    triangles,
    edges: none,
    rigidLinks: none,
    attached: none,
    fixed: none,
    actionLines: [],
  };
}

test("ALungKeepsItsMassWhileItsVolumeChanges", () => {
  for (const volume of [0.8, 1, 2, 3]) expect(lungDensity(1, volume) * volume).toBeCloseTo(0.3, 12);
  expect(lungCoefficient(1, 1)).toBeCloseTo(5.8, 1);
  expect(lungCoefficient(1, 2)).toBeLessThan(lungCoefficient(1, 1));
  expect(lungCoefficient(1, 1e9)).toBeCloseTo(air, 6);
});

test("AnInflatedLungIsLighterInTheScene", () => {
  const lung = body("lung-left", 0.08, Placement.STREAMED);
  const absorbers = new Absorbers([lung, body("rib-1-left", 0.02, Placement.RIGID)]);
  const poses = new Float32Array([0, 0, 0, 1, 0, 0, 0]);
  absorbers.update({ positions: lung.rest, poses });
  const before = absorbers.all[0].weight;
  expect(absorbers.lungs[0].density).toBeCloseTo(0.3, 6);
  absorbers.update({ positions: lung.rest.map((x) => 1.1 * x), poses });
  expect(absorbers.lungs[0].density).toBeCloseTo(0.3 / 1.331, 4);
  expect(absorbers.all[0].weight).toBeLessThan(before);
  // The mass that the rays meet: density times the volume of the surface.
  const volume = enclosedVolume(absorbers.all[0].vertices, lung.triangles);
  expect(absorbers.lungs[0].density * volume).toBeCloseTo(0.3 * enclosedVolume(lung.rest, lung.triangles), 8);
});

test("ALungWithoutBonesIsInNothing", () => {
  const lung = body("lung-left", 0.08, Placement.STREAMED);
  const absorbers = new Absorbers([lung]);
  absorbers.update({ positions: lung.rest, poses: new Float32Array() });
  expect(absorbers.all.map(({ name }) => name)).toEqual(["lung-left"]);
  expect(absorbers.all[0].weight).toBeCloseTo(5.8, 1);
});

test("ASmallGapIsClosedAndAnOpenSurfaceIsLeftOutAndNamed", () => {
  const lung = body("lung-left", 0.08, Placement.STREAMED);
  const torn = new Absorbers([{ ...lung, triangles: lung.triangles.slice(9) }]);
  expect(torn.open).toEqual([]);
  expect(isClosed(lung.rest, torn.all[0].triangles)).toBe(true);
  const half = new Absorbers([{ ...lung, triangles: lung.triangles.slice(lung.triangles.length / 2) }]);
  expect(half.open).toEqual(["lung-left"]);
  expect(half.all).toEqual([]);
});

test("LobesAreLungsOnlyInAbsenceOfALung", () => {
  const lungsOf = (...names: string[]) =>
    new Absorbers(names.map((name) => body(name, 0.08, Placement.STREAMED))).lungs.map(({ name }) => name);
  expect(lungsOf("lobe-upper-left", "lung-left")).toEqual(["lung-left"]);
  expect(lungsOf("lobe-upper-left", "lobe-lower-left")).toEqual(["lobe-upper-left", "lobe-lower-left"]);
});

test("BodiesAbsorbByTheirNames", () => {
  const of = (name: string, layer: string) => absorptionOf({ name, layer });
  expect(of("kidney-left", "kidneys")).toBe("organ");
  expect(of("lobe-upper-left", "upper-lobes")).toBe("lung");
  // The shoulder girdle is outside of the trunk's outline.
  expect(of("fissure-oblique-left", "fissures")).toBeUndefined();
  expect(of("clavicle-left", "clavicles")).toBeUndefined();
  expect(of("scapula-left", "scapulae")).toBeUndefined();
  expect(of("disc-t1", "discs")).toBe("cartilage");
  expect(of("t12", "spine")).toBe("vertebra");
  expect(of("rib-3-left", "ribs")).toBe("rib");
  expect(of("right-lower", "lungs")).toBe("lung");
  expect(of("trachea", "airways")).toBe("airway");
  expect(of("superior-vena-cava", "caval-veins")).toBe("blood");
  expect(of("chest-wall", "mechanics")).toBeUndefined();
});

test("TheServerHasTheSameNumbers", () => {
  const source = readFileSync(join(import.meta.dirname, "../../../server/fluoroscopy/attenuation.cc"), "utf8");
  const number = (name: string) => Number(new RegExp(`${name} = ([\\d.]+)`).exec(source)?.[1]);
  expect(100 * number("kCorticalBone") * 1.92).toBeCloseTo(materials.cortical.coefficient, 10);
  expect(100 * number("kSoft") * 1.06).toBeCloseTo(materials.organ.coefficient, 10);
  expect(50 * (number("kSoft") * 1.06 + number("kAdipose") * 0.95)).toBeCloseTo(materials.wall.coefficient, 10);
  expect(100 * number("kBlood") * 1.06).toBeCloseTo(materials.blood.coefficient, 10);
  expect(100 * number("kWater") * 1.015).toBeCloseTo(materials.fluid.coefficient, 10);
  expect(number("kLungDensityAtRest")).toBe(0.3);
});

test("TheTrunkIsClosedAndAroundItsBones", () => {
  const bones = [ball(0.1, 20).vertices, ball(0.05, 20).vertices.map((x, i) => (i % 3 === 2 ? x + 0.3 : x))];
  const { vertices, triangles } = trunkOutline(bones, -0.1, 0.35);
  expect(isClosed(vertices, triangles)).toBe(true);
  expect(enclosedVolume(vertices, triangles)).toBeGreaterThan(0.015);
  const heights = vertices.filter((_, i) => i % 3 === 2);
  expect(Math.min(...heights)).toBeLessThan(-0.19);
  expect(Math.max(...heights)).toBeGreaterThan(0.4);
  const sides = vertices.filter((_, i) => i % 3 === 0 && Math.abs(vertices[i + 2]) < 0.01);
  expect(Math.max(...sides)).toBeCloseTo(0.118, 3);
  expect(trunkOutline([], 0, 1).triangles.length).toBe(0);
});

test("GreyIsLinearInTheWindowAndInverted", () => {
  const sums = Float32Array.from({ length: 1000 }, (_, i) => i / 100);
  const { low, high } = windowOf(sums);
  expect(low).toBeGreaterThan(0.4);
  expect(high).toBeLessThan(10);
  expect(greyOf(low, { low, high, darkBones: false })).toBe(0);
  expect(greyOf(high, { low, high, darkBones: false })).toBe(255);
  expect(greyOf(high, { low, high, darkBones: true })).toBe(0);
  expect(windowOf(new Float32Array(4))).toEqual({ low: 0, high: 1 });
  const flat = windowOf(new Float32Array(100).fill(3));
  expect(flat.high - flat.low).toBeCloseTo(0.2, 6);
});
