import * as THREE from "three";
import { MeshBVH } from "three-mesh-bvh";
import type { Surface } from "../geometry/surface";

/** Computes distances to a triangle surface with a bounding volume hierarchy. */
export class NearestSurface {
  private readonly tree: MeshBVH;

  constructor({ positions, triangles }: Surface) {
    const geometry = new THREE.BufferGeometry()
      .setAttribute("position", new THREE.BufferAttribute(positions, 3))
      .setIndex(new THREE.BufferAttribute(triangles.slice(), 1)); // the tree reorders the indices
    this.tree = new MeshBVH(geometry);
  }

  /** Returns the distance of each point, x y z [m], from the surface [mm]. */
  distances(points: Float32Array): Float32Array {
    const result = new Float32Array(points.length / 3);
    const [point, last] = [new THREE.Vector3(), new THREE.Vector3()];
    const found = { point: new THREE.Vector3(), distance: Infinity, faceIndex: 0 };
    for (let i = 0; i < result.length; i++) {
      point.fromArray(points, 3 * i);
      // Upper bound: the distance of the previous point plus the distance between the points.
      const most = (1 + 1e-6) * (found.distance + point.distanceTo(last)) + 1e-9;
      if (this.tree.closestPointToPoint(point, found, 0, most) === null) this.tree.closestPointToPoint(point, found);
      result[i] = 1000 * found.distance;
      last.copy(point);
    }
    return result;
  }
}
