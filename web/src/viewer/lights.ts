import * as THREE from "three";
import { makeEnvironment } from "./environment";
import type { Quality } from "./quality";

/** Direction of the key light in the frame of the camera: x to the right, y up, z towards the viewer. */
const keyDirection = new THREE.Vector3(0.75, 1.05, 0.85).normalize();
const shadowTexels = 2048;

/**
 * The light of a studio, attached to the camera so that all views are lit alike: a soft key light from above right, the
 * light of a room from all sides, and a rim light that separates outlines from the background. The room is an
 * environment map in full and balanced quality and a hemisphere light in plain quality; the key light casts shadows in
 * full quality.
 */
export class StudioLights {
  private readonly key = new THREE.DirectionalLight("#fff3e6");
  private readonly room = new THREE.HemisphereLight("#eef2ff", "#6f5f58");
  private readonly rim = beam("#d5e0f5", [-0.8, 0.5, -1.3]);
  private readonly fill = beam("#dfe6ff", [-1.1, -0.2, 0.9]);
  private environment: THREE.Texture | undefined;

  constructor(
    private readonly scene: THREE.Scene,
    private readonly camera: THREE.Camera,
    private readonly renderer: THREE.WebGLRenderer,
  ) {
    camera.add(this.rim.holder, this.fill.holder);
    scene.add(camera, this.room, this.key, this.key.target);
    const { shadow } = this.key;
    shadow.mapSize.set(shadowTexels, shadowTexels);
    shadow.radius = 5;
    shadow.normalBias = 0.0012;
    shadow.bias = -0.0006;
    shadow.intensity = 0.9;
    renderer.shadowMap.type = THREE.PCFShadowMap;
  }

  /** Sets what the light may cost. */
  setQuality(quality: Quality): void {
    const plain = quality === "plain";
    if (!plain) this.environment ??= makeEnvironment(this.renderer);
    this.scene.environment = plain ? null : (this.environment ?? null);
    this.scene.environmentIntensity = 0.4;
    this.room.intensity = 1.3;
    this.room.visible = this.fill.light.visible = plain;
    this.key.intensity = plain ? 1.75 : 2.5;
    this.fill.light.intensity = 0.4;
    this.rim.light.intensity = 0.32;
    this.key.castShadow = this.renderer.shadowMap.enabled = quality === "full";
  }

  /** Turns the lights with the camera; the scene is around `center` and has this extent [m]. */
  follow(center: THREE.Vector3, extent: number): void {
    this.camera.updateMatrixWorld();
    const turn = this.camera.getWorldQuaternion(new THREE.Quaternion());
    this.scene.environmentRotation.setFromQuaternion(turn);
    this.room.position.set(0.2, 1, 0.25).applyQuaternion(turn);
    this.key.target.position.copy(center);
    this.key.position
      .copy(keyDirection)
      .applyQuaternion(turn)
      .multiplyScalar(1.5 * extent)
      .add(center);
    const { camera } = this.key.shadow;
    const half = 0.55 * extent;
    if (camera.right === half) return;
    Object.assign(camera, {
      left: -half,
      right: half,
      top: half,
      bottom: -half,
      near: 0.5 * extent,
      far: 2.5 * extent,
    });
    camera.updateProjectionMatrix();
  }
}

function beam(color: string, from: [number, number, number]) {
  const light = new THREE.DirectionalLight(color);
  light.position.set(...from);
  const holder = new THREE.Group();
  // The target moves with the camera as well, so that the light keeps its direction.
  holder.add(light, light.target);
  return { light, holder };
}
