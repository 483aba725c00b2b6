/**
 * Principal strains of a surface: the largest or smallest stretch of each triangle minus one [%], averaged over the
 * triangles around each vertex by rest area; NaN for a vertex without a triangle. With the edges u, v of a triangle and
 * their metric G at rest and g now, the stretches are the square roots of the eigenvalues l of g x = l G x: l^2 - l
 * (g11 G22 - 2 g12 G12 + g22 G11)/det G + det g/det G = 0.
 */
export function principalStrains(
  rest: Float32Array,
  now: Float32Array,
  triangles: Uint32Array,
  which: "largest" | "smallest",
): Float32Array {
  const count = rest.length / 3;
  const [sums, areas] = [new Float32Array(count), new Float32Array(count)];
  const sign = which === "largest" ? 1 : -1;
  const [G, g] = [new Float64Array(3), new Float64Array(3)];
  for (let t = 0; t < triangles.length; t += 3) {
    products(rest, triangles, t, G);
    products(now, triangles, t, g);
    const det = G[0] * G[2] - G[1] * G[1];
    if (!(det > 0)) continue;
    const half = (g[0] * G[2] - 2 * g[1] * G[1] + g[2] * G[0]) / det / 2;
    const spread = Math.sqrt(Math.max(0, half * half - (g[0] * g[2] - g[1] * g[1]) / det));
    const strain = Math.sqrt(Math.max(0, half + sign * spread)) - 1;
    const area = Math.sqrt(det) / 2;
    for (let k = t; k < t + 3; k++) {
      sums[triangles[k]] += area * strain;
      areas[triangles[k]] += area;
    }
  }
  return sums.map((sum, i) => (areas[i] > 0 ? (100 * sum) / areas[i] : NaN));
}

/** Writes u.u, u.v and v.v of the edges from the first corner: the metric of the triangle. */
function products(x: Float32Array, triangles: Uint32Array, t: number, out: Float64Array): void {
  const [a, b, c] = [3 * triangles[t], 3 * triangles[t + 1], 3 * triangles[t + 2]];
  const [ux, uy, uz] = [x[b] - x[a], x[b + 1] - x[a + 1], x[b + 2] - x[a + 2]];
  const [vx, vy, vz] = [x[c] - x[a], x[c + 1] - x[a + 1], x[c + 2] - x[a + 2]];
  out[0] = ux * ux + uy * uy + uz * uz;
  out[1] = ux * vx + uy * vy + uz * vz;
  out[2] = vx * vx + vy * vy + vz * vz;
}
