import { type Assumption, AssumptionKind, type PatientReport } from "../gen/phrenic/v1/patient_pb";
import { fixed, t } from "../language/translate";
import { partName } from "./finding_words";

type Words = (assumption: Assumption) => string;

const words: Partial<Record<AssumptionKind, Words>> = {
  [AssumptionKind.LUMBAR]: ({ values: [number, distance] }) =>
    t("No L{0}: assumed {1} mm from the next vertebra, to place the crura.", number, fixed(distance, 0)),
  [AssumptionKind.CAGE_WIDTH]: () => t("No ribs 6 to 12: the width of the lungs is used as the width of the cage."),
  [AssumptionKind.NO_STERNUM]: () => t("No sternum: the front of the rim is estimated from the spine."),
  [AssumptionKind.RIBS_LEFT_OUT]: ({ parts: [side] }) =>
    side === "left"
      ? t("Ribs on the left: a label of ribs without a number was left out, because others have numbers.")
      : t("Ribs on the right: a label of ribs without a number was left out, because others have numbers."),
  [AssumptionKind.RIBS_DIVIDED]: ({ parts: [side], values: [count] }) =>
    side === "left"
      ? t("Ribs on the left: one label, divided into {0} and numbered from the top; 12 are expected.", count)
      : t("Ribs on the right: one label, divided into {0} and numbered from the top; 12 are expected.", count),
  [AssumptionKind.GAPS_CLOSED]: ({ parts: [body], values: [label, gap] }) =>
    t(
      "{0}: label {1} had gaps; gaps of up to {2} voxels were closed, and the largest piece was used.",
      partName(body),
      label,
      gap,
    ),
  [AssumptionKind.MARGIN]: ({ values: [directions] }) =>
    t("Costal margin: no rib or cartilage 7 to 12 in {0} of 28 directions; interpolated.", directions),
  [AssumptionKind.WALL]: ({ values: [share, least, usual] }) =>
    t(
      "Chest wall: no bone in {0} % of the directions, bridged; bones are {1} mm from it at least, {2} mm in 95 %.",
      fixed(share, 0),
      fixed(least, 1),
      fixed(usual, 1),
    ),
  [AssumptionKind.TEMPLATE]: ({ parts, values: [x, y, z, off] }) =>
    t(
      "From the generated thorax, scaled by {0}, {1} and {2} along x, y and z, {3} mm from what is seen: {4}.",
      fixed(x, 2),
      fixed(y, 2),
      fixed(z, 2),
      fixed(off, 1),
      parts.map(partName).join(", "),
    ),
};

/**
 * Returns what was assumed, in the page's language; the server's sentence for a remark about a file, and for a kind that
 * this page does not know.
 */
export function assumptionWords({ fallbacks, assumptions }: PatientReport): string[] {
  return fallbacks.map((text, i) => {
    const assumption: Assumption | undefined = assumptions[i];
    return (assumption && words[assumption.kind]?.(assumption)) ?? text;
  });
}
