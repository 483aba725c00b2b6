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
    if (rgb !== undefined && this.painted?.array.length === rgb.length) return this.renew(rgb, this.painted);
    this.painted = rgb && new THREE.BufferAttribute(new Float32Array(rgb.length), 3);
    if (rgb !== undefined) this.renew(rgb, this.painted!);
    const colors = this.painted ?? this.own;
    if (colors === undefined) this.geometry.deleteAttribute("color");
    else this.geometry.setAttribute("color", colors);
    this.material.vertexColors = colors !== undefined;
    this.material.color.set(colors === undefined ? this.color : "white");
    if (this.covers) this.material.defines = { ...this.material.defines, PAINTED: "" };
    else delete this.material.defines?.PAINTED;
    this.material.needsUpdate = true;
  }

  private renew(rgb: Uint8Array, attribute: THREE.BufferAttribute): void {
    const values = attribute.array;
    for (let i = 0; i < rgb.length; i++) values[i] = linear[rgb[i]];
    attribute.needsUpdate = true;
  }
}

/** Light for each byte of sRGB. */
const linear = Float32Array.from(
  { length: 256 },
  (_, byte) => new THREE.Color().setRGB(byte / 255, 0, 0, THREE.SRGBColorSpace).r,
);
