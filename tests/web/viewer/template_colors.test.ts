import * as THREE from "three";
import { expect, test } from "vitest";
import { Structures } from "../../../web/src/anatomy/structures";
import { templateColor, withTemplate } from "../../../web/src/viewer/vertex_colors";
import { isFilled, templateLegend } from "../../../web/src/panels/view/template_legend";
import type { Body } from "../../../web/src/geometry/bodies";

const rgb = (color: string) => new THREE.Color(color).toArray();

test("FilledVerticesHaveTheirOwnColourAndOthersTheBodys", () => {
  const colors = withTemplate("#c04040", 3, new Uint32Array([1]), undefined)!;
  const of = (vertex: number) => [...colors.array].slice(3 * vertex, 3 * vertex + 3);
  for (const vertex of [0, 2]) rgb("#c04040").forEach((value, i) => expect(of(vertex)[i]).toBeCloseTo(value, 6));
  rgb(templateColor).forEach((value, i) => expect(of(1)[i]).toBeCloseTo(value, 6));
});

test("WithoutFilledVerticesColoursStayAsTheyAre", () => {
  const own = new THREE.BufferAttribute(new Float32Array([1, 0, 0]), 3);
  expect(withTemplate("#c04040", 1, new Uint32Array(0), own)).toBe(own);
  expect(withTemplate("#c04040", 1, undefined, undefined)).toBeUndefined();
});

const body = (name: string, template: number[]) =>
  ({
    name,
    rest: new Float32Array(12),
    triangles: new Uint32Array(0),
    rigidLinks: new Uint32Array(0),
    template: new Uint32Array(template),
  }) as unknown as Body;

test("AStructureKnowsItsFilledShareAndTheLegendIsForFilledBodies", () => {
  const bodies = [body("rib-5-left", [0, 1, 2, 3]), body("rib-6-left", []), body("lung-left", [3])];
  const shares = new Structures(bodies).all.map(({ body: name, filled }) => [name, filled]);
  expect(shares).toEqual([
    ["rib-5-left", 1],
    ["rib-6-left", undefined],
    ["lung-left", 0.25],
  ]);
  expect(isFilled(bodies)).toBe(true);
  expect(isFilled([bodies[1]])).toBe(false);
  expect(templateLegend(templateColor).textContent).toMatch(/generated thorax/);
});
