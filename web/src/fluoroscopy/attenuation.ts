import type { Body } from "../geometry/bodies";

/**
 * Mass attenuation coefficients at 70 keV [cm^2/g]: between the values of 60 and 80 keV of Hubbell and Seltzer's tables
 * (NIST Standard Reference Database 126; tissues of ICRU Report 44), interpolated in both logarithms. The server has
 * the same numbers in `server/fluoroscopy/attenuation.cc`.
 */
const perMass = {
  cortical: 0.2616,
  soft: 0.1924,
  adipose: 0.1879,
  blood: 0.193,
  lung: 0.1928,
  air: 0.1758,
  water: 0.1937,
};

/** Linear attenuation coefficients at 70 keV [1/m], from the coefficients by mass and a density [g/cm^3]. */
const linear = (coefficient: number, density: number) => 100 * coefficient * density;

const soft = linear(perMass.soft, 1.06);
const adipose = linear(perMass.adipose, 0.95);
export const air = linear(perMass.air, 0.0012);
/** Marrow between the trabeculae, as dense as soft tissue with little fat. */
const marrow = linear(perMass.soft, 1.02);

/** Density of lung tissue and blood per volume of lung at functional residual capacity [g/cm^3], CT's -700 HU. */
export const lungDensityAtRest = 0.3;

/** Returns a lung's coefficient [1/m]: its tissue and blood have the mass that they have at rest, the rest is air. */
export function lungCoefficient(restVolume: number, volume: number): number {
  const density = lungDensity(restVolume, volume);
  return linear(perMass.lung, density) + air * Math.max(0, 1 - density / 1.05);
}

/** Returns the density of a lung's tissue and blood per volume of lung [g/cm^3]. */
export function lungDensity(restVolume: number, volume: number): number {
  return (lungDensityAtRest * restVolume) / volume;
}

/** Returns the coefficient of a whole bone of this density [g/cm^3]: a mixture of cortical bone and marrow. */
function bone(density: number): number {
  const cortical = (density - 1.02) / (1.92 - 1.02);
  return cortical * linear(perMass.cortical, 1.92) + (1 - cortical) * marrow;
}

/** What absorbs, with its coefficient [1/m] and its words. */
export interface Material {
  words: string;
  coefficient: number;
}

/**
 * The materials; the densities of whole bones are those of ICRU Report 46 (Woodard and White, Br J Radiol
 * 1986;59:1209).
 */
export const materials = {
  wall: { words: "between the structures: half muscle, half fat", coefficient: (soft + adipose) / 2 },
  cortical: { words: "shell of a rib, 1.2 mm: cortical bone", coefficient: linear(perMass.cortical, 1.92) },
  marrow: { words: "inside of a rib: marrow", coefficient: marrow },
  vertebra: { words: "vertebra, as a whole", coefficient: bone(1.33) },
  sternum: { words: "sternum, as a whole", coefficient: bone(1.25) },
  cartilage: { words: "cartilage, disc", coefficient: linear(perMass.soft, 1.1) },
  muscle: { words: "muscle", coefficient: linear(perMass.soft, 1.05) },
  organ: { words: "liver, spleen, stomach, kidneys", coefficient: soft },
  blood: { words: "heart, vessels: blood", coefficient: linear(perMass.blood, 1.06) },
  fluid: { words: "pleural fluid", coefficient: linear(perMass.water, 1.015) },
  airway: { words: "windpipe: a third wall, two thirds air", coefficient: soft / 3 + (2 * air) / 3 },
  air: { words: "air", coefficient: air },
} satisfies Record<string, Material>;

/** How a body absorbs: a material, or a lung, whose coefficient follows its volume. */
export type Absorption = keyof typeof materials | "lung" | "rib";

const patterns: [RegExp, Absorption][] = [
  [/cartilage|^disc/, "cartilage"],
  [/lung|lobe/, "lung"],
  [/effusion|fluid/, "fluid"],
  [/pneumothorax|^air-|bubble/, "air"],
  [/^(heart|aorta)|cava|vein|vessel/, "blood"],
  [/^(liver|spleen|stomach|kidney)/, "organ"],
  [/airway|trachea/, "airway"],
  [/sternum|manubrium|xiphoid/, "sternum"],
  [/^rib/, "rib"],
  [/spine|vertebra|^[tl]\d+$/, "vertebra"],
  [/diaphragm|muscle|oesophagus/, "muscle"],
];

/** Returns how a body absorbs, from its name and its layer; undefined for what has no tissue, such as an inner wall. */
export function absorptionOf({ name, layer }: Pick<Body, "name" | "layer">): Absorption | undefined {
  if (layer === "mechanics") return undefined;
  return (patterns.find(([pattern]) => pattern.test(name)) ?? patterns.find(([pattern]) => pattern.test(layer)))?.[1];
}

const isLobe = ({ name }: Pick<Body, "name">) => name.startsWith("lobe-");

/** Returns the bodies that count: lobes are left out beside a lung, which they are drawn in a second time. */
export function withoutLobesOfLungs<B extends Pick<Body, "name" | "layer" | "triangles">>(bodies: B[]): B[] {
  const isLung = (body: B) => body.triangles.length > 0 && !isLobe(body) && absorptionOf(body) === "lung";
  return bodies.some(isLung) ? bodies.filter((body) => !isLobe(body)) : bodies;
}

/** True for what the outline of the trunk is drawn around. */
export function isBone(absorption: Absorption | undefined): boolean {
  return absorption === "rib" || absorption === "sternum" || absorption === "vertebra";
}
