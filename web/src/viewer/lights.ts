import * as THREE from "three";

/**
 * Lights that are attached to the camera, so that all views are lit alike: a hemisphere light, a key light from the
 * upper left, a fill light, and a rim light from behind that separates outlines from the background.
 */
export function addLights(scene: THREE.Scene, camera: THREE.Camera): void {
  scene.add(new THREE.HemisphereLight("#f4f6ff", "#8f827c", 1.3));
  camera.add(
    beam("#fff6ec", 2.35, [-0.9, 1.1, 0.9]),
    beam("#ffeee6", 0.8, [1.2, -0.5, 0.8]),
    beam("#bcd4ff", 1.5, [0.7, 0.8, -1.4]),
  );
  scene.add(camera);
}

function beam(color: string, intensity: number, from: [number, number, number]): THREE.Object3D {
  const light = new THREE.DirectionalLight(color, intensity);
  light.position.set(...from);
  const holder = new THREE.Group();
  // The target moves with the camera as well, so that the light keeps its direction.
  holder.add(light, light.target);
  return holder;
}
