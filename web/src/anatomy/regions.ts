import type { Body } from "../geometry/bodies";
import { tendonWeights } from "../geometry/tendon";
import { edgesOf } from "../geometry/edges";

/** Half the distance of the outer borders of both crura [m]: they lie on the bodies of the vertebrae. */
const crusReach = 0.03;

/**
 * Returns the region of each vertex of a diaphragm, by name, from what the geometry tells: the central tendon is where
 * rigid links are, the crura lie in front of the lumbar vertebrae, and the rest is divided by the median plane.
 */
export function diaphragmRegions(diaphragm: Body, bodies: Body[]): string[] {
  const { rest, rigidLinks } = diaphragm;
  const lumbarTop = topOf(bodies.find(({ name }) => name === "l1"));
  const tendon = rigidLinks.length > 0 ? tendonOf(diaphragm) : undefined;
  return Array.from({ length: rest.length / 3 }, (_, i) => {
    const [x, , z] = rest.subarray(3 * i, 3 * i + 3);
    const side = x < 0 ? "right" : "left";
    if (tendon !== undefined && tendon[i] > 0.5) return "central tendon";
    return z < lumbarTop && Math.abs(x) < crusReach ? `${side} crus` : `${side} half`;
  });
}

function tendonOf({ rigidLinks, triangles, rest }: Body): Float32Array {
  return tendonWeights(rigidLinks, edgesOf(triangles, rest.length / 3), rest.length / 3, 2);
}

/** Returns the largest height of a body at rest [m]; -Infinity without a body. */
function topOf(body: Body | undefined): number {
  let top = -Infinity;
  for (let i = 2; i < (body?.rest.length ?? 0); i += 3) top = Math.max(top, body!.rest[i]);
  return top;
}
