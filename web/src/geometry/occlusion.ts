/** A surface that takes part in ambient occlusion: rest positions, x y z per vertex [m], triangles, unit normals. */
export interface OccludedSurface {
  rest: Float32Array;
  triangles: Uint32Array;
  normals: Float32Array;
  /** False for a translucent surface, which darkens nothing. */
  occludes: boolean;
}

/** Cells along the longest side of the scene: about 6 mm for a thorax. */
const cellsAcross = 72;
/** Directions over the sphere, and cells along each; farther surfaces do not darken. */
const directionCount = 26;
const reach = 7;

/**
 * Returns how much of the sky above each vertex is covered by surfaces nearby, 0 (open) to 255 (covered), at rest. Rays
 * are marched through a grid of occupied cells, so that the time is proportional to the number of vertices: about 50 ms
 * for a thorax.
 */
export function computeOcclusion(surfaces: OccludedSurface[]): Uint8Array<ArrayBuffer>[] {
  const grid = new OccupiedCells(surfaces);
  return surfaces.map((surface) => occlusionOf(surface, grid));
}

function occlusionOf({ rest, normals }: OccludedSurface, grid: OccupiedCells): Uint8Array<ArrayBuffer> {
  const result = new Uint8Array(rest.length / 3);
  for (let v = 0; v < rest.length; v += 3) {
    let [covered, all] = [0, 0];
    for (let d = 0; d < directions.length; d += 3) {
      const [x, y, z] = [directions[d], directions[d + 1], directions[d + 2]];
      const facing = x * normals[v] + y * normals[v + 1] + z * normals[v + 2];
      if (facing < 0.2) continue;
      all += facing;
      covered += facing * grid.cover(rest, normals, v, x, y, z);
    }
    result[v / 3] = all > 0 ? Math.round((255 * covered) / all) : 0;
  }
  return result;
}

/** Directions that cover the sphere evenly (a Fibonacci spiral), x y z each. */
const directions = Float32Array.from({ length: 3 * directionCount }, (_, k) => {
  const i = Math.floor(k / 3);
  const z = 1 - (2 * i + 1) / directionCount;
  const turn = i * Math.PI * (3 - Math.sqrt(5));
  return [Math.sqrt(1 - z * z) * Math.cos(turn), Math.sqrt(1 - z * z) * Math.sin(turn), z][k % 3];
});

/** A grid over the scene whose cells are occupied where a surface passes. */
class OccupiedCells {
  private low = [Infinity, Infinity, Infinity];
  private readonly size: number;
  private readonly counts: [number, number, number];
  private readonly cells: Uint8Array;

  constructor(surfaces: OccludedSurface[]) {
    const high = [-Infinity, -Infinity, -Infinity];
    for (const { rest } of surfaces)
      rest.forEach((value, i) => {
        this.low[i % 3] = Math.min(this.low[i % 3], value);
        high[i % 3] = Math.max(high[i % 3], value);
      });
    const extents = high.map((value, k) => Math.max(0, value - this.low[k]));
    this.size = Math.max(...extents, 1e-9) / cellsAcross;
    const count = (k: number) => Math.floor(extents[k] / this.size + 0.5) + 1;
    // A flat scene lies in the middle of its cells.
    this.low = this.low.map((value) => value - 0.5 * this.size);
    this.counts = [count(0), count(1), count(2)];
    this.cells = new Uint8Array(this.counts[0] * this.counts[1] * this.counts[2]);
    for (const surface of surfaces) if (surface.occludes) this.fill(surface);
  }

  /** Occupies the cells of the corners and the centre of each triangle: triangles are about as large as cells. */
  private fill({ rest, triangles }: OccludedSurface): void {
    for (let t = 0; t < triangles.length; t += 3) {
      const [a, b, c] = [3 * triangles[t], 3 * triangles[t + 1], 3 * triangles[t + 2]];
      const middle = (k: number) => (rest[a + k] + rest[b + k] + rest[c + k]) / 3;
      for (const i of [a, b, c]) this.occupy(rest[i], rest[i + 1], rest[i + 2]);
      this.occupy(middle(0), middle(1), middle(2));
    }
  }

  private occupy(x: number, y: number, z: number): void {
    const at = this.cellAt(x, y, z);
    if (at >= 0) this.cells[at] = 1;
  }

  /** Returns the index of the cell at a place; -1 outside of the grid. */
  private cellAt(x: number, y: number, z: number): number {
    const [nx, ny, nz] = this.counts;
    const i = Math.floor((x - this.low[0]) / this.size);
    const j = Math.floor((y - this.low[1]) / this.size);
    const k = Math.floor((z - this.low[2]) / this.size);
    return i < 0 || j < 0 || k < 0 || i >= nx || j >= ny || k >= nz ? -1 : i + nx * (j + ny * k);
  }

  /** Returns how strongly a ray from vertex `v` is covered, 0 to 1: near surfaces cover more than distant ones. */
  cover(rest: Float32Array, normals: Float32Array, v: number, x: number, y: number, z: number): number {
    // Starts outside of the cells of the surface itself.
    const lift = 1.5 * this.size;
    for (let step = 1; step <= reach; step++) {
      const along = step * this.size;
      const at = this.cellAt(
        rest[v] + lift * normals[v] + along * x,
        rest[v + 1] + lift * normals[v + 1] + along * y,
        rest[v + 2] + lift * normals[v + 2] + along * z,
      );
      if (at < 0) return 0;
      if (this.cells[at] > 0) return 1 - (step - 1) / reach;
    }
    return 0;
  }
}
