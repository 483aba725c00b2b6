import * as THREE from "three";

/** The colours of a surface: its own, one for all or one a vertex, until others are painted over them. */
export class Paint {
  private painted: THREE.BufferAttribute | undefined;

  constructor(
    private readonly geometry: THREE.BufferGeometry,
    private readonly material: THREE.MeshStandardMaterial,
    private readonly color: string,
    private readonly own: THREE.BufferAttribute | undefined,
  ) {
    this.show(undefined);
  }

  get covers(): boolean {
    return this.painted !== undefined;
  }

  /** sRGB, three bytes a vertex; undefined for the surface's own colours. */
  show(rgb: Uint8Array | undefined): void {
    this.painted = rgb && attributeOf(rgb);
    const colors = this.painted ?? this.own;
    if (colors === undefined) this.geometry.deleteAttribute("color");
    else this.geometry.setAttribute("color", colors);
    this.material.vertexColors = colors !== undefined;
    this.material.color.set(colors === undefined ? this.color : "white");
    if (this.covers) this.material.defines = { ...this.material.defines, PAINTED: "" };
    else delete this.material.defines?.PAINTED;
    this.material.needsUpdate = true;
  }
}

function attributeOf(rgb: Uint8Array): THREE.BufferAttribute {
  const values = new Float32Array(rgb.length);
  const color = new THREE.Color();
  for (let i = 0; i < rgb.length; i += 3) {
    color.setRGB(rgb[i] / 255, rgb[i + 1] / 255, rgb[i + 2] / 255, THREE.SRGBColorSpace).toArray(values, i);
  }
  return new THREE.BufferAttribute(values, 3);
}
