import * as THREE from "three";

type Triple = [number, number, number];

/** Linear light of the room's ceiling, walls and floor. */
const ceiling: Triple = [0.85, 0.9, 1];
const walls: Triple = [0.42, 0.43, 0.47];
const floor: Triple = [0.3, 0.22, 0.19];
/** Lamps: direction in the frame of the camera, width and height at a distance of 5, and linear light. */
const lamps: [Triple, number, number, number][] = [
  [[0.8, 1.1, 0.7], 3.4, 2.4, 9],
  [[-1.2, 0.35, 0.5], 1.2, 3.6, 2.6],
  [[0.2, 0.4, -1.3], 4, 1, 2.2],
];

/**
 * Returns the light of a small studio as a prefiltered environment map, in the frame of the camera: x to the right, y
 * up, z towards the viewer. It is computed from a few shapes, so that the page loads no picture.
 */
export function makeEnvironment(renderer: THREE.WebGLRenderer): THREE.Texture {
  const room = new THREE.Scene();
  room.add(walledSphere(), ...lamps.map(([at, width, height, light]) => lamp(at, width, height, light)));
  const generator = new THREE.PMREMGenerator(renderer);
  const { texture } = generator.fromScene(room, 0.03);
  generator.dispose();
  room.traverse((object) => {
    if (!(object instanceof THREE.Mesh)) return;
    object.geometry.dispose();
    object.material.dispose();
  });
  return texture;
}

function walledSphere(): THREE.Mesh {
  const geometry = new THREE.SphereGeometry(10, 24, 16);
  const { position } = geometry.attributes;
  const colors = new Float32Array(3 * position.count);
  for (let i = 0; i < position.count; i++) {
    const height = position.getY(i) / 10;
    const end = height > 0 ? ceiling : floor;
    for (let k = 0; k < 3; k++) colors[3 * i + k] = THREE.MathUtils.lerp(walls[k], end[k], Math.abs(height));
  }
  geometry.setAttribute("color", new THREE.BufferAttribute(colors, 3));
  return new THREE.Mesh(geometry, new THREE.MeshBasicMaterial({ vertexColors: true, side: THREE.BackSide }));
}

function lamp(at: Triple, width: number, height: number, light: number): THREE.Mesh {
  const material = new THREE.MeshBasicMaterial({ side: THREE.DoubleSide });
  material.color.setScalar(light);
  const mesh = new THREE.Mesh(new THREE.PlaneGeometry(width, height), material);
  mesh.position.set(...at).setLength(5);
  mesh.lookAt(0, 0, 0);
  return mesh;
}
