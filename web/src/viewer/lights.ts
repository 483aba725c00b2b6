import * as THREE from "three";

/**
 * Light that hangs on the camera, so that every view is lit alike: a soft sky, a key from the upper left that shapes
 * the surfaces, a fill, and a cool rim from behind that lifts outlines off the background.
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
  // The target rides along, or the beam would turn as the camera moves.
  holder.add(light, light.target);
  return holder;
}
