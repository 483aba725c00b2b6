import * as THREE from "three";
import { describe, expect, test } from "vitest";
import { simplified } from "../../../web/src/geometry/simplified";

/** Returns a torus of 30 and 10 mm, its seams joined, or the open half of it. */
function torus(around: number, across: number, arc = 2 * Math.PI) {
  const closed = arc === 2 * Math.PI;
  const rings = closed ? around : around + 1;
  const rest = new Float32Array(3 * rings * across);
  const triangles: number[] = [];
  for (let i = 0; i < rings; i++) {
    for (let j = 0; j < across; j++) {
      const [u, v] = [(arc * i) / around, (2 * Math.PI * j) / across];
      const radius = 0.03 + 0.01 * Math.cos(v);
      rest.set([radius * Math.cos(u), radius * Math.sin(u), 0.01 * Math.sin(v)], 3 * (i * across + j));
      if (i === around) continue;
      const [next, up] = [(i + 1) % rings, (j + 1) % across];
      const [a, b, c, d] = [i * across + j, next * across + j, next * across + up, i * across + up];
      triangles.push(a, b, c, a, c, d);
    }
  }
  return { rest, triangles: new Uint32Array(triangles) };
}

const tube = (x: number, y: number, z: number) => Math.abs(Math.hypot(Math.hypot(x, y) - 0.03, z) - 0.01);

/** Returns the largest distance of the triangles' middles from the torus [m]. */
function farthest(rest: Float32Array, triangles: Uint32Array): number {
  let most = 0;
  for (let t = 0; t < triangles.length; t += 3) {
    const middle = new THREE.Vector3();
    for (let k = 0; k < 3; k++) middle.add(new THREE.Vector3().fromArray(rest, 3 * triangles[t + k]));
    middle.divideScalar(3);
    most = Math.max(most, tube(middle.x, middle.y, middle.z));
  }
  return most;
}

/** Returns the edges that only one triangle has. */
function borders(triangles: Uint32Array): number {
  const count = new Map<string, number>();
  for (let i = 0; i < triangles.length; i++) {
    const ends = [triangles[i], triangles[i % 3 === 2 ? i - 2 : i + 1]].sort((a, b) => a - b).join(" ");
    count.set(ends, (count.get(ends) ?? 0) + 1);
  }
  return [...count.values()].filter((each) => each === 1).length;
}

describe("simplified triangles", () => {
  test("FollowTheSurfaceAndStayClosed", async () => {
    const { rest, triangles } = torus(120, 60);
    const fewer = await simplified(rest, triangles);
    expect(fewer.length).toBeLessThan(0.3 * triangles.length);
    expect(farthest(rest, fewer)).toBeLessThan(0.0006);
    expect(borders(fewer)).toBe(0);
  });

  test("KeepOpenBorders", async () => {
    const { rest, triangles } = torus(60, 60, Math.PI);
    const fewer = await simplified(rest, triangles);
    expect(fewer.length).toBeLessThan(0.5 * triangles.length);
    expect(borders(fewer)).toBe(borders(triangles));
  });

  test("OfSmallBodiesAreTheirOwn", async () => {
    const { rest, triangles } = torus(12, 10);
    expect(await simplified(rest, triangles)).toBe(triangles);
  });
});
