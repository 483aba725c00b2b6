import type * as THREE from "three";
import { LineMaterial } from "three/addons/lines/LineMaterial.js";
import { LineSegments2 } from "three/addons/lines/LineSegments2.js";
import { LineSegmentsGeometry } from "three/addons/lines/LineSegmentsGeometry.js";

/** Lines several pixels wide between pairs of vertices; native WebGL lines are one pixel wide. */
export class ThickLines {
  readonly object: LineSegments2;
  private readonly ends: Float32Array;

  constructor(
    private readonly pairs: Uint32Array,
    private readonly positions: THREE.BufferAttribute,
    color: string,
    width: number,
  ) {
    this.ends = new Float32Array(3 * pairs.length);
    const material = new LineMaterial({ color, linewidth: width, toneMapped: false });
    this.object = new LineSegments2(new LineSegmentsGeometry(), material);
    this.object.frustumCulled = false;
    this.copyEnds();
    this.object.geometry.setPositions(this.ends);
  }

  /** Copies the current positions to the lines. */
  update(): void {
    this.copyEnds();
    const start = this.object.geometry.getAttribute("instanceStart") as THREE.InterleavedBufferAttribute;
    start.data.set(this.ends);
    start.data.needsUpdate = true;
  }

  private copyEnds(): void {
    const source = this.positions.array;
    this.pairs.forEach((vertex, i) => {
      for (let k = 0; k < 3; k++) this.ends[3 * i + k] = source[3 * vertex + k];
    });
  }
}
