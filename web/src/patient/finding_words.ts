import { termsOf } from "../anatomy/terms";
import { FindingKind, type ReadinessFinding } from "../gen/phrenic/v1/patient_pb";
import { fixed, t } from "../language/translate";

type Words = (finding: ReadinessFinding) => string;

const words: Partial<Record<FindingKind, Words>> = {
  [FindingKind.LUNG_CUT]: ({ parts: [lung, side], values: [area] }) =>
    t(
      "{0}: cut by the {1} border of the scan over {2} cm², so that its volume and its base are not known. Use a scan from the apices of the lungs to L3.",
      partName(lung),
      t(sides[side] ?? side),
      fixed(area, 0),
    ),
  [FindingKind.RIBS_CUT]: ({ parts }) =>
    t(
      "The border of the scan cuts {0}: their motion is that of the part that is left. Use a scan that has whole ribs.",
      names(parts),
    ),
  [FindingKind.RIBS_MISSING]: ({ parts }) =>
    t(
      "Missing: {0}. The wall, the costal margin and the axes of the cage are guessed there. Label them, or use a scan that shows them.",
      names(parts),
    ),
  [FindingKind.FILLED]: ({ parts, values: [off, share] }) =>
    t(
      "Not seen, but filled from the generated thorax, which fits what is seen to {0} mm: {1}. Their shape is not the person's, and {2} % of the diaphragm rests on them. Label them if the scan shows them.",
      fixed(off, 1),
      names(parts),
      fixed(100 * share, 0),
    ),
  [FindingKind.ORGANS_MISSING]: ({ parts }) =>
    t("No label for {0}: the domes are guessed from the lungs alone there. Label them.", names(parts)),
  [FindingKind.EXTRAPOLATED]: ({ parts, values: [share] }) =>
    t(
      "{0} % of the diaphragm is extrapolated, not seen: {1}. Label the organs and ribs beside it, or the diaphragm itself.",
      fixed(100 * share, 0),
      parts.map(sectorName).join("; "),
    ),
  [FindingKind.ODD_AXES]: ({ parts, values }) =>
    t(
      "Axes of ribs are at angles to the midsagittal plane that no person has: {0}. These ribs would move inwards or not at all. Check that their necks are in the scan and labelled.",
      parts.map((rib, i) => `${partName(rib)} ${fixed(values[i], 0)}°`).join(", "),
    ),
  [FindingKind.TOWER]: ({ values: [height] }) =>
    t(
      "The middle of the diaphragm is {0} mm above its domes: it was drawn up between the lungs. Label the heart.",
      fixed(height, 0),
    ),
  [FindingKind.CROSSED]: ({ values: [places] }) =>
    t(
      "The diaphragm crosses itself at rest in {0} places: it is crumpled. Check that the labels of lungs and organs do not overlap or leave gaps.",
      places,
    ),
  [FindingKind.ODD_AREA]: ({ values: [area] }) =>
    t(
      "The diaphragm has {0} cm²; adults have 700 to 1300 cm². Check the voxels' spacing, and that the scan shows the whole thorax of an adult.",
      fixed(area, 0),
    ),
};

const sides: Record<string, string> = {
  upper: "upper",
  lower: "lower",
  left: "left",
  right: "right",
  front: "front",
  back: "back",
};

const sectors: Record<string, string> = { dome: "dome", wall: "wall", ...sides };

/** Returns what was found, in the page's language; the server's sentence for a kind that this page does not know. */
export function findingWords(finding: ReadinessFinding): string {
  return words[finding.kind]?.(finding) ?? finding.what;
}

function names(parts: string[]): string {
  return parts.map(partName).join(", ");
}

/** Returns the name of a body, "rib-5-left", in the page's language. */
export function partName(body: string): string {
  if (body === "stomach-or-spleen") return t("stomach or spleen");
  return termsOf(body.replace("-lobe-", "-"))[0]?.name ?? body;
}

/** Returns a sector, "wall, left, back", in the page's language. */
function sectorName(sector: string): string {
  return sector
    .split(", ")
    .map((word) => t(sectors[word] ?? word))
    .join(", ");
}
