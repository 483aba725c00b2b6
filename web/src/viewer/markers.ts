import * as THREE from "three";
import type { Marker } from "../geometry/vertices";

/** Spheres of constant size on the screen, drawn over everything. */
export class Markers {
  readonly object = new THREE.Group();
  private readonly ball = new THREE.SphereGeometry(1, 16, 12);

  /** Replaces all markers. */
  show(markers: Marker[]): void {
    while (this.object.children.length > markers.length) this.object.remove(this.object.children.at(-1)!);
    while (this.object.children.length < markers.length) this.object.add(this.make());
    markers.forEach(({ position, color, unclipped = false }, i) => {
      const mesh = this.object.children[i] as THREE.Mesh<THREE.SphereGeometry, THREE.MeshBasicMaterial>;
      mesh.position.fromArray(position);
      mesh.material.color.set(color);
      setUnclipped(mesh.material, unclipped);
    });
  }

  /** Sets the radius at the centre of the scene [m]. */
  scale(size: number): void {
    for (const child of this.object.children) child.scale.setScalar(size);
  }

  private make(): THREE.Mesh {
    const material = new THREE.MeshBasicMaterial({
      depthTest: false,
      transparent: true,
      opacity: 0.95,
      fog: false,
      toneMapped: false,
    });
    const mesh = new THREE.Mesh(this.ball, material);
    mesh.renderOrder = 5;
    return mesh;
  }
}

/** Exempts a material from the planes that clip the scene, or not. */
function setUnclipped(material: THREE.MeshBasicMaterial, unclipped: boolean): void {
  if (material.userData.unclipped === unclipped) return;
  material.userData.unclipped = unclipped;
  const unchanged = "#include <clipping_planes_fragment>";
  material.customProgramCacheKey = () => `unclipped ${unclipped}`;
  material.onBeforeCompile = (shader) => {
    if (unclipped) shader.fragmentShader = shader.fragmentShader.replace(unchanged, "");
  };
  material.needsUpdate = true;
}
