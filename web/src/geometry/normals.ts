/**
 * Computes area-weighted vertex normals of a triangle surface: the normalised sum of the triangles' cross products.
 * Works on plain arrays in one pass, since it runs for every frame.
 */
export function computeNormals(positions: Float32Array, triangles: Uint32Array, normals: Float32Array): void {
  normals.fill(0);
  for (let t = 0; t < triangles.length; t += 3) {
    addTriangle(positions, normals, 3 * triangles[t], 3 * triangles[t + 1], 3 * triangles[t + 2]);
  }
  for (let v = 0; v < normals.length; v += 3) {
    const length = Math.sqrt(normals[v] ** 2 + normals[v + 1] ** 2 + normals[v + 2] ** 2) || 1;
    normals[v] /= length;
    normals[v + 1] /= length;
    normals[v + 2] /= length;
  }
}

function addTriangle(p: Float32Array, n: Float32Array, a: number, b: number, c: number): void {
  const ux = p[b] - p[a];
  const uy = p[b + 1] - p[a + 1];
  const uz = p[b + 2] - p[a + 2];
  const vx = p[c] - p[a];
  const vy = p[c + 1] - p[a + 1];
  const vz = p[c + 2] - p[a + 2];
  const x = uy * vz - uz * vy;
  const y = uz * vx - ux * vz;
  const z = ux * vy - uy * vx;
  n[a] += x;
  n[a + 1] += y;
  n[a + 2] += z;
  n[b] += x;
  n[b + 1] += y;
  n[b + 2] += z;
  n[c] += x;
  n[c + 1] += y;
  n[c + 2] += z;
}
