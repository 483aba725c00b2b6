import { cornerWeights, type Lattice, type Place } from "./lattice";

/** What lung tissue is coloured by. */
export type TissueKind = "displacement" | "ventilation" | "strain";

/** Points of a lung whose places are found once: the vertices of its surface. */
export class Places {
  readonly count: number;
  private readonly nodes: Int32Array;
  private readonly weights: Float32Array;

  /** `points` are x y z at rest [m]. */
  constructor(lattice: Lattice, points: ArrayLike<number>) {
    this.count = points.length / 3;
    this.nodes = new Int32Array(8 * this.count);
    this.weights = new Float32Array(8 * this.count);
    for (let i = 0; i < this.count; i++) {
      const place = lattice.place(points[3 * i], points[3 * i + 1], points[3 * i + 2]);
      this.nodes.set(lattice.corners.subarray(8 * place.brick, 8 * place.brick + 8), 8 * i);
      this.weights.set(cornerWeights(place), 8 * i);
    }
  }

  /** Returns a field of the nodes at each point. */
  values(field: Float32Array): Float32Array {
    const result = new Float32Array(this.count);
    for (let i = 0; i < result.length; i++) {
      let sum = 0;
      for (let c = 8 * i; c < 8 * i + 8; c++) sum += this.weights[c] * field[this.nodes[c]];
      result[i] = sum;
    }
    return result;
  }
}

/** The tissue of one lung at one moment, relative to rest. */
export class TissueState {
  /** x y z of each node [m]. */
  private readonly displacement: Float32Array;
  private strains: Record<"ventilation" | "strain", Float32Array> | undefined;
  private distance: Float32Array | undefined;

  constructor(
    readonly lattice: Lattice,
    amplitudes: ArrayLike<number>,
  ) {
    this.displacement = lattice.displacements(amplitudes);
  }

  /** Returns a field on the nodes: displacement [mm], volume gained and largest principal strain [%]. */
  nodal(kind: TissueKind): Float32Array {
    if (kind === "displacement") return (this.distance ??= lengths(this.displacement));
    this.strains ??= this.computeStrains();
    return this.strains[kind];
  }

  /** Returns the displacement of tissue whose place at rest is given [m]. */
  displacementAt(place: Place): [number, number, number] {
    const sum: [number, number, number] = [0, 0, 0];
    this.addDisplacement(place, cornerWeights(place), sum);
    return sum;
  }

  /**
   * Returns the place at rest of the tissue that is at a point now [m]: x - u, with u taken at x and twice improved.
   */
  placeOf(x: number, y: number, z: number): Place {
    const place: Place = { brick: 0, local: [0, 0, 0] };
    this.findNow(x, y, z, place, new Float64Array(8), [0, 0, 0]);
    return place;
  }

  /** Returns a function that reads a field of the tissue that is at a point now [m], for pictures of many points. */
  reader(kind: TissueKind): (x: number, y: number, z: number) => number {
    const field = this.nodal(kind);
    const { corners } = this.lattice;
    const place: Place = { brick: 0, local: [0, 0, 0] };
    const [weights, u] = [new Float64Array(8), [0, 0, 0]];
    return (x, y, z) => {
      this.findNow(x, y, z, place, weights, u);
      cornerWeights(place, weights);
      let sum = 0;
      for (let c = 0; c < 8; c++) sum += weights[c] * field[corners[8 * place.brick + c]];
      return sum;
    };
  }

  private findNow(x: number, y: number, z: number, place: Place, weights: Float64Array, u: number[]): void {
    this.lattice.find(x, y, z, place);
    for (let i = 0; i < 2; i++) {
      u[0] = u[1] = u[2] = 0;
      this.addDisplacement(place, cornerWeights(place, weights), u);
      this.lattice.find(x - u[0], y - u[1], z - u[2], place);
    }
  }

  private addDisplacement({ brick }: Place, weights: Float64Array, sum: number[]): void {
    for (let c = 0; c < 8; c++) {
      const first = 3 * this.lattice.corners[8 * brick + c];
      sum[0] += weights[c] * this.displacement[first];
      sum[1] += weights[c] * this.displacement[first + 1];
      sum[2] += weights[c] * this.displacement[first + 2];
    }
  }

  /** Computes both in the middle of each brick, and the mean over the bricks at a node, by their part inside. */
  private computeStrains(): Record<"ventilation" | "strain", Float32Array> {
    const { corners, inside, nodeCount } = this.lattice;
    const [ventilation, strain, weights] = [0, 1, 2].map(() => new Float32Array(nodeCount));
    const gradient = new Float64Array(9);
    for (let brick = 0; brick < inside.length; brick++) {
      this.gradientIn(brick, gradient);
      const gained = 100 * (gradient[0] + gradient[4] + gradient[8]);
      const largest = 100 * largestStrain(gradient);
      for (let c = 8 * brick; c < 8 * brick + 8; c++) {
        ventilation[corners[c]] += inside[brick] * gained;
        strain[corners[c]] += inside[brick] * largest;
        weights[corners[c]] += inside[brick];
      }
    }
    for (let i = 0; i < nodeCount; i++) {
      ventilation[i] /= weights[i];
      strain[i] /= weights[i];
    }
    return { ventilation, strain };
  }

  /** Writes du_i/dx_j in the middle of a brick, row by row. */
  private gradientIn(brick: number, gradient: Float64Array): void {
    gradient.fill(0);
    const scale = 1 / (4 * this.lattice.edge);
    for (let c = 0; c < 8; c++) {
      const first = 3 * this.lattice.corners[8 * brick + c];
      for (let j = 0; j < 3; j++) {
        const sign = (c >> j) & 1 ? scale : -scale;
        for (let i = 0; i < 3; i++) gradient[3 * i + j] += sign * this.displacement[first + i];
      }
    }
  }
}

function lengths(vectors: Float32Array): Float32Array {
  const result = new Float32Array(vectors.length / 3);
  for (let i = 0; i < result.length; i++)
    result[i] = 1000 * Math.hypot(vectors[3 * i], vectors[3 * i + 1], vectors[3 * i + 2]);
  return result;
}

/**
 * Returns the largest eigenvalue of the symmetric part of a 3 x 3 matrix, by the angle of its deviator (Smith 1961,
 * "Eigenvalues of a symmetric 3 x 3 matrix").
 */
export function largestStrain(g: ArrayLike<number>): number {
  const mean = (g[0] + g[4] + g[8]) / 3;
  const [a, b, c] = [g[0] - mean, g[4] - mean, g[8] - mean];
  const [d, e, f] = [(g[1] + g[3]) / 2, (g[5] + g[7]) / 2, (g[2] + g[6]) / 2];
  const size = Math.sqrt((a * a + b * b + c * c + 2 * (d * d + e * e + f * f)) / 6);
  if (size === 0) return mean;
  const determinant = a * (b * c - e * e) - d * (d * c - e * f) + f * (d * e - b * f);
  const cosine = Math.min(1, Math.max(-1, determinant / (2 * size ** 3)));
  return mean + 2 * size * Math.cos(Math.acos(cosine) / 3);
}
