import * as THREE from "three";
import { MeshBVH } from "three-mesh-bvh";
import type { Surface } from "../geometry/surface";

/** A surface that tells soon how far a point is from it: from its triangles, not from its vertices. */
export class NearestSurface {
  private readonly tree: MeshBVH;

  constructor({ positions, triangles }: Surface) {
    const geometry = new THREE.BufferGeometry()
      .setAttribute("position", new THREE.BufferAttribute(positions, 3))
      .setIndex(new THREE.BufferAttribute(triangles.slice(), 1)); // the tree puts them in an order of its own
    this.tree = new MeshBVH(geometry);
  }

  /** Of each point, x y z [m], its distance to the surface [mm]. */
  distances(points: Float32Array): Float32Array {
    const result = new Float32Array(points.length / 3);
    const [point, last] = [new THREE.Vector3(), new THREE.Vector3()];
    const found = { point: new THREE.Vector3(), distance: Infinity, faceIndex: 0 };
    for (let i = 0; i < result.length; i++) {
      point.fromArray(points, 3 * i);
      // No farther than the point before was, and the way from it to here.
      const most = (1 + 1e-6) * (found.distance + point.distanceTo(last)) + 1e-9;
      if (this.tree.closestPointToPoint(point, found, 0, most) === null) this.tree.closestPointToPoint(point, found);
      result[i] = 1000 * found.distance;
      last.copy(point);
    }
    return result;
  }
}
