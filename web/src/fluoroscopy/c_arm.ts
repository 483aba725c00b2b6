type Vector = [number, number, number];

/** Where a C-arm stands. */
export interface CArm {
  /**
   * Angle of the detector to the patient's left [degrees]: positive LAO, negative RAO; 0 PA, 180 AP, 90 left lateral.
   */
  lao: number;
  /** Angle of the detector towards the head [degrees]: positive cranial, negative caudal. */
  cranial: number;
  /** Distance from source to detector [m]; undefined for parallel rays. */
  sourceToDetector: number | undefined;
}

/** Distance from the isocentre, the middle of the thorax, to the detector [m]. */
export const isocentreToDetector = 0.3;

/** How rays pass: the isocentre [m], unit vectors, and what the picture shows. */
export interface Projection {
  isocentre: Vector;
  /** To the right and up in the picture, seen from the detector, and from the isocentre to the detector. */
  right: Vector;
  up: Vector;
  toDetector: Vector;
  /** Distance from the source to the isocentre [m]; 0 for parallel rays. */
  sourceDistance: number;
  /** Half the width and height of the picture in the plane of the isocentre [m]. */
  halfWidth: number;
}

/** Half the width of the picture in the plane of the isocentre [m]. */
export const fieldHalfWidth = 0.21;

/** Returns the rays of a C-arm around this isocentre [m]. */
export function projectionOf({ lao, cranial, sourceToDetector }: CArm, isocentre: Vector): Projection {
  const [a, b] = [(lao * Math.PI) / 180, (cranial * Math.PI) / 180];
  const [sa, ca, sb, cb] = [Math.sin(a), Math.cos(a), Math.sin(b), Math.cos(b)];
  return {
    isocentre,
    toDetector: [sa * cb, -ca * cb, sb],
    right: [ca, sa, 0],
    up: [-sa * sb, ca * sb, cb],
    sourceDistance: sourceToDetector === undefined ? 0 : sourceToDetector - isocentreToDetector,
    halfWidth: fieldHalfWidth,
  };
}

/**
 * True if pictures are shown mirrored: with the detector behind the patient, they are read as if facing the patient.
 */
export function isMirrored({ lao }: CArm): boolean {
  return Math.abs(lao) > 90;
}

/** Returns where a point [m] is in the picture, -1 to 1 to the right and up. */
export function pictureOf(point: readonly number[], at: Projection, mirrored = false): [x: number, y: number] {
  const p = point.map((each, i) => each - at.isocentre[i]);
  const along = (axis: Vector) => axis[0] * p[0] + axis[1] * p[1] + axis[2] * p[2];
  const scale = at.sourceDistance === 0 ? 1 : (at.sourceDistance + along(at.toDetector)) / at.sourceDistance;
  const [x, y] = [along(at.right) / scale / at.halfWidth, along(at.up) / scale / at.halfWidth];
  return [mirrored ? -x : x, y];
}

/** A projection with the name that radiologists give it. */
export interface NamedProjection {
  name: string;
  words: string;
  lao: number;
  cranial: number;
}

/** The standard projections. */
export const standardProjections: NamedProjection[] = [
  { name: "PA", words: "From back to front, the standard radiograph", lao: 0, cranial: 0 },
  { name: "AP", words: "From front to back, as in bed: the heart is larger", lao: 180, cranial: 0 },
  { name: "Left lateral", words: "From right to left", lao: 90, cranial: 0 },
  { name: "LAO 30", words: "Detector 30° to the patient's left, in front", lao: 30, cranial: 0 },
  { name: "RAO 30", words: "Detector 30° to the patient's right, in front", lao: -30, cranial: 0 },
];

/** Returns the name of a C-arm's angles, as radiologists write it: "PA", "LAO 45°, cranial 10°". */
export function angleName({ lao, cranial }: Pick<CArm, "lao" | "cranial">): string {
  const named = standardProjections.find((each) => each.lao === lao && each.cranial === cranial);
  if (named !== undefined) return named.name;
  const side = lao === 0 ? "PA" : Math.abs(lao) === 180 ? "AP" : `${lao > 0 ? "LAO" : "RAO"} ${Math.abs(lao)}°`;
  if (cranial === 0) return side;
  return `${side}, ${cranial > 0 ? "cranial" : "caudal"} ${Math.abs(cranial)}°`;
}

/** Returns the letters of the patient's sides at the left and the right of the picture. */
export function sideLetters(arm: CArm): [left: string, right: string] {
  const [x, y] = [Math.cos((arm.lao * Math.PI) / 180), Math.sin((arm.lao * Math.PI) / 180)];
  const ends = Math.abs(x) >= Math.SQRT1_2 ? ["R", "L"] : ["A", "P"];
  const forward = (Math.abs(x) >= Math.SQRT1_2 ? x : y) > 0 !== isMirrored(arm);
  return forward ? [ends[0], ends[1]] : [ends[1], ends[0]];
}
