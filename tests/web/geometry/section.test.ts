import { expect, test } from "vitest";
import { outlineOf, paintSection } from "../../../web/src/geometry/section";

const radius = 0.05;
const step = 0.001;

/** A ball around (0.1, 0, 0.2) of triangles between meridians. */
function ball(): { positions: number[]; triangles: number[] } {
  const [rings, around] = [40, 80];
  const positions: number[] = [];
  const triangles: number[] = [];
  for (let i = 0; i <= rings; i++) {
    for (let j = 0; j < around; j++) {
      const [polar, turn] = [(Math.PI * i) / rings, (2 * Math.PI * j) / around];
      const across = radius * Math.sin(polar);
      positions.push(0.1 + across * Math.cos(turn), across * Math.sin(turn), 0.2 + radius * Math.cos(polar));
      if (i === rings) continue;
      const [a, b] = [around * i + j, around * i + ((j + 1) % around)];
      triangles.push(a, a + around, b, b, a + around, b + around);
    }
  }
  return { positions, triangles };
}

const planes = [
  { axis: 0, at: 0.1203 },
  { axis: 1, at: -0.0203 },
  { axis: 2, at: 0.2203 },
] as const;

test.each(planes)("ACutOfABallHasTheAreaOfItsCircle", (plane) => {
  const { positions, triangles } = ball();
  const outline = outlineOf(positions, triangles, plane, step)!;
  const picture = paintSection(outline, plane, step, () => [1, 2, 3]);
  let covered = 0;
  for (let i = 3; i < picture.rgba.length; i += 4) covered += picture.rgba[i] / 255;
  const circle = Math.PI * (radius ** 2 - 0.0203 ** 2);
  expect(covered * step ** 2).toBeGreaterThan(0.98 * circle);
  expect(covered * step ** 2).toBeLessThan(1.01 * circle);
});

test("APictureIsColouredAtThePlacesOfItsPixels", () => {
  const { positions, triangles } = ball();
  const plane = planes[1];
  const outline = outlineOf(positions, triangles, plane, step)!;
  const seen: [number, number, number][] = [];
  paintSection(outline, plane, step, (x, y, z) => {
    seen.push([x, y, z]);
    return [0, 0, 0];
  });
  expect(seen.length).toBeGreaterThan(1000);
  for (const [x, y, z] of seen) {
    expect(y).toBe(plane.at);
    expect(Math.hypot(x - 0.1, y, z - 0.2)).toBeLessThan(radius + 2 * step);
  }
});

test("APlaneBesideTheBallCutsNothing", () => {
  const { positions, triangles } = ball();
  expect(outlineOf(positions, triangles, { axis: 0, at: 0.3 }, step)).toBeUndefined();
});
