/** Returns |x - x_rest| of each vertex [mm]. */
export function displacements(rest: Float32Array, now: Float32Array): Float32Array {
  return distances(rest, now, 1000);
}

/** Returns the speed of each vertex between two frames [mm/s]; 0 if `seconds` is 0. */
export function speeds(before: Float32Array, now: Float32Array, seconds: number): Float32Array {
  return distances(before, now, seconds > 0 ? 1000 / seconds : 0);
}

function distances(from: Float32Array, to: Float32Array, factor: number): Float32Array {
  const result = new Float32Array(from.length / 3);
  for (let i = 0; i < result.length; i++) {
    const x = to[3 * i] - from[3 * i];
    const y = to[3 * i + 1] - from[3 * i + 1];
    const z = to[3 * i + 2] - from[3 * i + 2];
    result[i] = factor * Math.sqrt(x * x + y * y + z * z);
  }
  return result;
}

/** Returns the relative area change of the triangles around each vertex [%]; NaN for a vertex without a triangle. */
export function areaChanges(rest: Float32Array, now: Float32Array, triangles: Uint32Array): Float32Array {
  const before = areas(rest, triangles);
  return areas(now, triangles).map((area, i) => (before[i] > 0 ? 100 * (area / before[i] - 1) : NaN));
}

function areas(x: Float32Array, triangles: Uint32Array): Float32Array {
  const result = new Float32Array(x.length / 3);
  for (let t = 0; t < triangles.length; t += 3) {
    const [a, b, c] = [3 * triangles[t], 3 * triangles[t + 1], 3 * triangles[t + 2]];
    const [ux, uy, uz] = [x[b] - x[a], x[b + 1] - x[a + 1], x[b + 2] - x[a + 2]];
    const [vx, vy, vz] = [x[c] - x[a], x[c + 1] - x[a + 1], x[c + 2] - x[a + 2]];
    const [nx, ny, nz] = [uy * vz - uz * vy, uz * vx - ux * vz, ux * vy - uy * vx];
    const area = Math.sqrt(nx * nx + ny * ny + nz * nz) / 2;
    for (let k = 0; k < 3; k++) result[triangles[t + k]] += area;
  }
  return result;
}
