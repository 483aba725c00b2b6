import * as THREE from "three";

/** A lit surface material. Transparent surfaces are denser towards their silhouette, like glass and wet membranes. */
export function surfaceMaterial(color: string, opacity: number): THREE.MeshStandardMaterial {
  const material = new THREE.MeshStandardMaterial({
    color,
    roughness: 0.5,
    metalness: 0,
    side: THREE.DoubleSide,
    polygonOffset: true,
    polygonOffsetFactor: 1,
    polygonOffsetUnits: 1,
  });
  material.onBeforeCompile = (shader) => {
    shader.fragmentShader = shader.fragmentShader.replace(
      "#include <opaque_fragment>",
      `#ifndef OPAQUE
         float facing = abs(dot(normal, normalize(vViewPosition)));
         diffuseColor.a *= mix(1.0 + 1.6 * (1.0 - diffuseColor.a), 0.75, facing);
       #endif
       #ifdef PAINTED
         // Colours that are read off a scale keep to it: light gives them shape, and no gloss.
         outgoingLight = mix(reflectedLight.directDiffuse + reflectedLight.indirectDiffuse, diffuseColor.rgb, 0.55);
       #endif
       #include <opaque_fragment>`,
    );
  };
  setOpacity(material, opacity);
  return material;
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
  return new THREE.LineBasicMaterial({ color, opacity, transparent: true, depthTest: !onTop, depthWrite: false });
}

/** Round points of `size` CSS pixels. */
export function pointMaterial(color: string, size: number): THREE.PointsMaterial {
  return new THREE.PointsMaterial({
    color,
    size: size * Math.min(devicePixelRatio, 2),
    sizeAttenuation: false,
    map: disc(),
    alphaTest: 0.5,
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
