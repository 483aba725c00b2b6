/** Returns each edge of the triangles once, as pairs of vertex indices with the smaller one first. */
export function edgesOf(triangles: Uint32Array, vertexCount: number): Uint32Array<ArrayBuffer> {
  const keys = new Float64Array(triangles.length);
  for (let i = 0; i < triangles.length; i++) {
    const a = triangles[i];
    const b = triangles[i % 3 === 2 ? i - 2 : i + 1];
    keys[i] = Math.min(a, b) * vertexCount + Math.max(a, b);
  }
  keys.sort();
  const unique = keys.filter((key, i) => i === 0 || key !== keys[i - 1]);
  const edges = new Uint32Array(2 * unique.length);
  unique.forEach((key, i) => {
    edges[2 * i] = Math.floor(key / vertexCount);
    edges[2 * i + 1] = key % vertexCount;
  });
  return edges;
}
