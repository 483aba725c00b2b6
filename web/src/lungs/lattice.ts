import type { GetTissueResponse } from "../gen/phrenic/v1/tissue_pb";
import { floats } from "../geometry/wire_arrays";

/** A place in a brick: `local` is 0 to 1 inside. */
export interface Place {
  brick: number;
  local: [number, number, number];
}

/**
 * The bricks of one lung's tissue at rest and the shapes of its motion (proto/README.md). Corner c of a brick has the
 * coordinates (c & 1, c >> 1 & 1, c >> 2 & 1), in edges.
 */
export class Lattice {
  readonly name: string;
  /** Edge of a brick [m]. */
  readonly edge: number;
  readonly nodeCount: number;
  /** Eight nodes per brick. */
  readonly corners: Int32Array;
  /** The part of each brick inside the lung, above 0 to 1. */
  readonly inside: Float32Array;
  readonly shapeCount: number;
  private readonly shapes: Float32Array;
  private readonly origin: [number, number, number];
  private readonly cells: [number, number, number];
  /** The cell of each brick. */
  private readonly cellOf: number[] = [];
  /** Its coordinates, three numbers per brick. */
  private readonly brickCells: Int32Array;
  /** The brick in each cell, or the nearest one. */
  private readonly nearest: Int32Array;

  /** Throws RangeError, naming the field, for arrays of wrong length. */
  constructor({ name, origin, edge, cells, bricks, shapes, shapeCount }: GetTissueResponse) {
    this.name = name;
    this.edge = edge;
    this.origin = [origin?.x ?? 0, origin?.y ?? 0, origin?.z ?? 0];
    if (cells.length !== 3) throw new RangeError(`${name}.cells: ${cells.length} numbers instead of 3.`);
    this.cells = [cells[0], cells[1], cells[2]];
    const count = cells[0] * cells[1] * cells[2];
    if (bricks.length !== count) throw new RangeError(`${name}.bricks: ${bricks.length} bytes instead of ${count}.`);
    bricks.forEach((byte, cell) => byte > 0 && this.cellOf.push(cell));
    this.inside = Float32Array.from(this.cellOf, (cell) => Math.max(1e-3, (bricks[cell] - 1) / 254));
    [this.corners, this.nodeCount] = this.numberNodes();
    this.shapeCount = shapeCount;
    this.shapes = floats(shapes, 3, `${name}.shapes`);
    const wanted = 3 * this.nodeCount * shapeCount;
    if (this.shapes.length !== wanted)
      throw new RangeError(`${name}.shapes: ${this.shapes.length} numbers instead of ${wanted}.`);
    this.nearest = this.nearestBricks();
    this.brickCells = Int32Array.from(this.cellOf.flatMap((cell) => this.coordinates(cell)));
  }

  /** Returns the displacement of each node, x y z [m], for the amplitudes of the shapes [m]. */
  displacements(amplitudes: ArrayLike<number>): Float32Array {
    const sum = new Float32Array(3 * this.nodeCount);
    for (let k = 0; k < this.shapeCount; k++) {
      const [amplitude, first] = [amplitudes[k], k * sum.length];
      for (let i = 0; i < sum.length; i++) sum[i] += amplitude * this.shapes[first + i];
    }
    return sum;
  }

  /** Returns the place of a point at rest [m]; outside the bricks the nearest place of the nearest one. */
  place(x: number, y: number, z: number): Place {
    const place: Place = { brick: 0, local: [0, 0, 0] };
    this.find(x, y, z, place);
    return place;
  }

  /** The same, written to `place`, for pictures of many points. */
  find(x: number, y: number, z: number, place: Place): void {
    const nx = this.cells[0];
    const ny = this.cells[1];
    const nz = this.cells[2];
    const a = (x - this.origin[0]) / this.edge;
    const b = (y - this.origin[1]) / this.edge;
    const c = (z - this.origin[2]) / this.edge;
    const cell = clamped(a, nx) + nx * (clamped(b, ny) + ny * clamped(c, nz));
    const own = 3 * (place.brick = this.nearest[cell]);
    place.local[0] = Math.min(1, Math.max(0, a - this.brickCells[own]));
    place.local[1] = Math.min(1, Math.max(0, b - this.brickCells[own + 1]));
    place.local[2] = Math.min(1, Math.max(0, c - this.brickCells[own + 2]));
  }

  private coordinates(cell: number): [number, number, number] {
    const [nx, ny] = this.cells;
    return [cell % nx, Math.floor(cell / nx) % ny, Math.floor(cell / (nx * ny))];
  }

  /** Numbers the corners of the bricks in the order of the lattice, x fastest. */
  private numberNodes(): [Int32Array, number] {
    const [nx, ny, nz] = this.cells.map((each) => each + 1);
    const nodeAt = new Int32Array(nx * ny * nz).fill(-1);
    const points = this.cellOf.map((cell) => {
      const [x, y, z] = this.coordinates(cell);
      return Array.from({ length: 8 }, (_, c) => {
        return x + (c & 1) + nx * (y + ((c >> 1) & 1) + ny * (z + ((c >> 2) & 1)));
      });
    });
    for (const point of points.flat()) nodeAt[point] = 0;
    let count = 0;
    for (let i = 0; i < nodeAt.length; i++) if (nodeAt[i] === 0) nodeAt[i] = count++;
    return [Int32Array.from(points.flat(), (point) => nodeAt[point]), count];
  }

  /** Spreads the bricks to the cells around, one cell at a time. */
  private nearestBricks(): Int32Array {
    const [nx, ny, nz] = this.cells;
    const nearest = new Int32Array(nx * ny * nz).fill(-1);
    let front = this.cellOf.slice();
    front.forEach((cell, brick) => (nearest[cell] = brick));
    while (front.length > 0) {
      const next: number[] = [];
      for (const cell of front) {
        const [x, y, z] = this.coordinates(cell);
        const around = [
          [x > 0, cell - 1],
          [x < nx - 1, cell + 1],
          [y > 0, cell - nx],
          [y < ny - 1, cell + nx],
          [z > 0, cell - nx * ny],
          [z < nz - 1, cell + nx * ny],
        ] as const;
        for (const [exists, other] of around) {
          if (!exists || nearest[other] >= 0) continue;
          nearest[other] = nearest[cell];
          next.push(other);
        }
      }
      front = next;
    }
    return nearest;
  }
}

function clamped(at: number, cells: number): number {
  return Math.min(cells - 1, Math.max(0, Math.floor(at)));
}

/** Writes the trilinear weight of each corner of a brick at a place. */
export function cornerWeights({ local }: Place, weights: Float64Array = new Float64Array(8)): Float64Array {
  // No destructuring of arrays: it is slow, and pictures have thousands of points.
  const x = local[0];
  const y = local[1];
  const z = local[2];
  for (let c = 0; c < 8; c++) weights[c] = (c & 1 ? x : 1 - x) * (c & 2 ? y : 1 - y) * (c & 4 ? z : 1 - z);
  return weights;
}
