import * as THREE from "three";
import { usePlainShading } from "./plain_shader";
import { addTissue, type TissueUniforms } from "./tissue_shader";
import type { Tissue } from "./tissues";

/**
 * A lit surface material for a tissue; plain without the define DETAILED. `moving`: the geometry has its rest positions
 * in the attribute `rest`.
 */
export function surfaceMaterial(
  color: string,
  opacity: number,
  tissue: Tissue,
  moving: boolean,
  fibreAxis: THREE.Vector2,
): THREE.MeshStandardMaterial {
  const material = new THREE.MeshStandardMaterial({
    color,
    roughness: tissue.roughness,
    metalness: 0,
    side: THREE.DoubleSide,
    polygonOffset: true,
    polygonOffsetFactor: 1,
    polygonOffsetUnits: 1,
    shadowSide: THREE.DoubleSide,
  });
  material.defines = { ...material.defines, DETAILED: "" };
  if (moving) material.defines.MOVING = "";
  if (tissue.fibres > 0) material.defines.FIBRES = "";
  const uniforms: TissueUniforms = {
    sheen: { value: tissue.sheen },
    fibres: { value: tissue.fibres },
    fibreAxis: { value: fibreAxis },
    spots: { value: tissue.spots },
    spotsPerMetre: { value: 1 / tissue.spotSize },
    scatter: { value: tissue.scatter },
    section: { value: new THREE.Color(tissue.section ?? color) },
  };
  material.onBeforeCompile = (shader) => {
    if ("DETAILED" in (material.defines ?? {})) addTissue(shader, uniforms);
    else usePlainShading(shader, uniforms);
  };
  setOpacity(material, opacity);
  return material;
}

/** Sets or removes a define of the shader. */
export function setDefine(material: THREE.Material, name: string, on: boolean): void {
  const defines = { ...material.defines };
  if (name in defines === on) return;
  if (on) defines[name] = "";
  else delete defines[name];
  material.defines = defines;
  material.needsUpdate = true;
}

/** Sets the opacity, 0 to 1; transparent materials do not write depth. */
export function setOpacity(material: THREE.Material, opacity: number): void {
  const transparent = opacity < 1;
  if (material.transparent !== transparent) material.needsUpdate = true;
  material.opacity = opacity;
  material.transparent = transparent;
  material.depthWrite = !transparent;
}

/** Lines of one pixel; `onTop` disables the depth test. */
export function lineMaterial(color: string, opacity: number, onTop: boolean): THREE.LineBasicMaterial {
  return new THREE.LineBasicMaterial({
    color,
    opacity,
    transparent: true,
    depthTest: !onTop,
    depthWrite: false,
    toneMapped: false,
  });
}

/** Round points of `size` CSS pixels. */
export function pointMaterial(color: string, size: number): THREE.PointsMaterial {
  return new THREE.PointsMaterial({
    color,
    size: size * Math.min(devicePixelRatio, 2),
    sizeAttenuation: false,
    map: disc(),
    alphaTest: 0.5,
    toneMapped: false,
  });
}

function disc(): THREE.Texture {
  const size = 32;
  const texels = new Uint8Array(4 * size * size).fill(255);
  for (let i = 0; i < size * size; i++) {
    const radius = Math.hypot((i % size) - 15.5, Math.floor(i / size) - 15.5);
    texels[4 * i + 3] = Math.max(0, Math.min(255, 255 * (15.5 - radius) + 127));
  }
  const texture = new THREE.DataTexture(texels, size, size);
  texture.needsUpdate = true;
  return texture;
}
