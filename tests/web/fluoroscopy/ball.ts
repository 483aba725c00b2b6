/** Returns a closed ball around the origin, of triangles that face outwards: meridians and parallels. */
export function ball(
  radius: number,
  rings = 100,
): { vertices: Float32Array<ArrayBuffer>; triangles: Uint32Array<ArrayBuffer> } {
  const around = 2 * rings;
  const vertices: number[] = [0, 0, -radius];
  for (let k = 1; k < rings; k++) {
    const polar = (Math.PI * k) / rings;
    for (let i = 0; i < around; i++) {
      const angle = (2 * Math.PI * i) / around;
      const ring = radius * Math.sin(polar);
      vertices.push(ring * Math.cos(angle), ring * Math.sin(angle), -radius * Math.cos(polar));
    }
  }
  const top = vertices.push(0, 0, radius) / 3 - 1;
  const at = (k: number, i: number) => 1 + (k - 1) * around + (i % around);
  const triangles: number[] = [];
  for (let i = 0; i < around; i++) {
    triangles.push(0, at(1, i + 1), at(1, i), top, at(rings - 1, i), at(rings - 1, i + 1));
    for (let k = 1; k + 1 < rings; k++)
      triangles.push(at(k, i), at(k, i + 1), at(k + 1, i + 1), at(k, i), at(k + 1, i + 1), at(k + 1, i));
  }
  return { vertices: new Float32Array(vertices), triangles: new Uint32Array(triangles) };
}
