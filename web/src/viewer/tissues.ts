import type { Body } from "../geometry/bodies";

/** How a kind of tissue looks. */
export interface Tissue {
  /** 0 (mirror) to 1 (matt). */
  roughness: number;
  /** Strength of the sheen at grazing angles, 0 to 1. */
  sheen: number;
  /** Depth of the pattern of fibres around the vertical axis, 0 to 1. */
  fibres: number;
  /** Strength of irregular spots, 0 to 1, and their size [m]. */
  spots: number;
  spotSize: number;
  /** Part of the light that the tissue scatters back from all sides, 0 to 1. */
  scatter: number;
  /** Colour of a cut through the tissue; undefined for tissue that is no closed body. */
  section?: string;
  /** Thickness of the wall of a hollow organ, whose `section` is that of its lumen [m]. */
  wall?: number;
}

const hollow = { roughness: 0.5, sheen: 0.1, fibres: 0, spots: 0.05, spotSize: 0.008, scatter: 0.1 };
const lung = { roughness: 0.8, sheen: 0.1, fibres: 0, spots: 0.2, spotSize: 0.006, scatter: 0.4 };

const kinds = {
  muscle: { roughness: 0.6, sheen: 0.14, fibres: 0.8, spots: 0.1, spotSize: 0.012, scatter: 0.1, section: "#7d2a24" },
  bone: { roughness: 0.95, sheen: 0, fibres: 0, spots: 0.13, spotSize: 0.004, scatter: 0, section: "#c48f72" },
  cartilage: {
    roughness: 0.7,
    sheen: 0.06,
    fibres: 0,
    spots: 0.05,
    spotSize: 0.004,
    scatter: 0.05,
    section: "#aab5ae",
  },
  organ: { roughness: 0.55, sheen: 0.12, fibres: 0, spots: 0.12, spotSize: 0.008, scatter: 0.1, section: "#63332a" },
  artery: { ...hollow, section: "#4f0f10", wall: 0.002 },
  vein: { ...hollow, section: "#26304f", wall: 0.0013 },
  airway: { ...hollow, section: "#17191c", wall: 0.0018 },
  gut: { ...hollow, section: "#6e4138", wall: 0.003 },
  lung,
  lobe: { ...lung, section: "#b98079" },
  other: { roughness: 0.6, sheen: 0.05, fibres: 0, spots: 0, spotSize: 1, scatter: 0 },
} satisfies Record<string, Tissue>;

/** The kinds of tissue. */
export type TissueKind = keyof typeof kinds;

const patterns: [RegExp, TissueKind][] = [
  [/cartilage|^disc/, "cartilage"],
  [/^(heart|liver|spleen|kidney)/, "organ"],
  [/aorta/, "artery"],
  [/cava/, "vein"],
  [/airways|trachea/, "airway"],
  [/oesophagus|stomach/, "gut"],
  [/^lobe-|^fissure-/, "lobe"],
  [/diaphragm|muscle|intercostal/, "muscle"],
  [/rib|sternum|manubrium|xiphoid|spine|vertebra|bone|clavicle|scapula/, "bone"],
  [/lung|lobe/, "lung"],
];

/** Returns the kind of tissue of a body, from its layer and its name. */
export function tissueKind({ layer, name }: Pick<Body, "layer" | "name">): TissueKind {
  return patterns.find(([pattern]) => pattern.test(layer) || pattern.test(name))?.[1] ?? "other";
}

/** Returns how a body looks. */
export function tissueOf(body: Pick<Body, "layer" | "name">): Tissue {
  return kinds[tissueKind(body)];
}
