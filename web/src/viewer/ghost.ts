import * as THREE from "three";
import { Placement } from "../gen/phrenic/v1/frames_pb";
import { type Body, type FrameArrays, positionsOf } from "../geometry/bodies";
import { computeNormals } from "../geometry/normals";
import type { Surface } from "../geometry/surface";

interface Colors {
  color: string;
  emissive: string;
}

/** Translucent surfaces: the deformable bodies in another state, or a compared surface. */
export class TranslucentSurfaces {
  readonly object = new THREE.Group();

  constructor(private readonly colors: Colors) {
    this.object.renderOrder = 3;
  }

  /** Shows a fixed surface. */
  showSurface({ positions, triangles }: Surface): void {
    this.clear();
    this.object.add(translucentMesh(positions, triangles, this.colors));
  }

  /** Shows the streamed ones of `bodies`; at rest if `arrays` is undefined. An outline covers no colours. */
  show(bodies: Body[], arrays: FrameArrays | undefined, outline = false): void {
    this.clear();
    for (const body of bodies) {
      if (body.placement !== Placement.STREAMED || body.triangles.length === 0) continue;
      const positions = arrays === undefined ? body.rest : positionsOf(body, arrays).slice();
      this.object.add(translucentMesh(positions, body.triangles, this.colors, outline));
    }
  }

  /** Removes all surfaces and releases GPU resources. */
  clear(): void {
    for (const child of this.object.children) {
      if (!(child instanceof THREE.Mesh)) continue;
      child.geometry.dispose();
      child.material.dispose();
    }
    this.object.clear();
  }
}

/** A mesh that is denser at its silhouette and clearer where it faces the camera; an outline is invisible there. */
function translucentMesh(positions: Float32Array, triangles: Uint32Array, colors: Colors, outline = false): THREE.Mesh {
  const normals = new Float32Array(positions.length);
  computeNormals(positions, triangles, normals);
  const geometry = new THREE.BufferGeometry()
    .setAttribute("position", new THREE.BufferAttribute(positions, 3))
    .setAttribute("normal", new THREE.BufferAttribute(normals, 3))
    .setIndex(new THREE.BufferAttribute(triangles, 1));
  const material = new THREE.MeshLambertMaterial({
    ...colors,
    transparent: true,
    opacity: 0.3,
    toneMapped: false,
    depthWrite: false,
    side: THREE.DoubleSide,
  });
  const density = outline ? "3.0 * pow(1.0 - facing, 4.0)" : "mix(2.6, 0.45, facing)";
  material.customProgramCacheKey = () => density;
  material.onBeforeCompile = (shader) => {
    shader.fragmentShader = shader.fragmentShader.replace(
      "#include <opaque_fragment>",
      `float facing = abs(dot(normalize(vNormal), normalize(vViewPosition)));
       diffuseColor.a *= ${density};
       #include <opaque_fragment>`,
    );
  };
  const mesh = new THREE.Mesh(geometry, material);
  mesh.frustumCulled = false;
  return mesh;
}
