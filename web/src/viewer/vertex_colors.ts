import * as THREE from "three";

/** Colour of what was filled from the generated thorax, and is not the person's. */
export const templateColor = "#8a5cd6";

/** Returns a surface's own colours with those of its vertices that were filled. */
export function withTemplate(
  color: string,
  count: number,
  filled: Uint32Array | undefined,
  own: THREE.BufferAttribute | undefined,
): THREE.BufferAttribute | undefined {
  if (!filled?.length) return own;
  const colors = own ?? new THREE.BufferAttribute(new Float32Array(3 * count), 3);
  if (own === undefined) for (let i = 0; i < count; i++) new THREE.Color(color).toArray(colors.array, 3 * i);
  for (const vertex of filled) new THREE.Color(templateColor).toArray(colors.array, 3 * vertex);
  return colors;
}

/** The colours of a surface: its own, uniform or per vertex, or those of a field. */
export class VertexColors {
  private field: THREE.BufferAttribute | undefined;

  constructor(
    private readonly geometry: THREE.BufferGeometry,
    private readonly material: THREE.MeshStandardMaterial,
    private readonly color: string,
    private readonly ownColors: THREE.BufferAttribute | undefined,
  ) {
    this.set(undefined);
  }

  /** True if field colours are shown. */
  get active(): boolean {
    return this.field !== undefined;
  }

  /** Sets field colours, three sRGB bytes per vertex; undefined restores the surface's own colours. */
  set(rgb: Uint8Array | undefined): void {
    if (rgb !== undefined && this.field?.array.length === rgb.length) return this.write(rgb, this.field);
    this.field = rgb && new THREE.BufferAttribute(new Float32Array(rgb.length), 3);
    if (rgb !== undefined) this.write(rgb, this.field!);
    const colors = this.field ?? this.ownColors;
    if (colors === undefined) this.geometry.deleteAttribute("color");
    else this.geometry.setAttribute("color", colors);
    this.material.vertexColors = colors !== undefined;
    this.material.color.set(colors === undefined ? this.color : "white");
    if (this.active) this.material.defines = { ...this.material.defines, PAINTED: "" };
    else delete this.material.defines?.PAINTED;
    // Colours that are read off a scale have exactly its colours.
    this.material.toneMapped = this.material.fog = !this.active;
    this.material.needsUpdate = true;
  }

  private write(rgb: Uint8Array, attribute: THREE.BufferAttribute): void {
    const values = attribute.array;
    for (let i = 0; i < rgb.length; i++) values[i] = linearLight[rgb[i]];
    attribute.needsUpdate = true;
  }
}

/** Linear light for each sRGB byte. */
const linearLight = Float32Array.from(
  { length: 256 },
  (_, byte) => new THREE.Color().setRGB(byte / 255, 0, 0, THREE.SRGBColorSpace).r,
);
