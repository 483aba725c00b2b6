import { termsOf } from "../anatomy/terms";
import type { LabelMeaning } from "../gen/phrenic/v1/patient_pb";
import { Organ } from "../gen/phrenic/v1/patient_pb";
import type { MissingStructure } from "../gen/phrenic/v1/patients_pb";
import { Side } from "../gen/phrenic/v1/geometry_pb";
import { Structure } from "../gen/phrenic/v1/scene_pb";
import { t } from "../language/translate";

const organs: Partial<Record<Organ, string>> = {
  [Organ.HEART]: "heart",
  [Organ.LIVER]: "liver",
  [Organ.STOMACH]: "stomach",
  [Organ.SPLEEN]: "spleen",
};

const sideWord = (side: Side) => (side === Side.LEFT ? "left" : "right");

/** Returns the name of a label's meaning in the page's language; its name in the label map if it has no other. */
export function nameOf({ name, what }: LabelMeaning): string {
  return termsOf(bodyOf(name, what))[0]?.name ?? otherNames(name);
}

/** Returns the name of the body that the server makes of a label. */
function bodyOf(name: string, what: LabelMeaning["what"]): string {
  if (what.case === "anatomy") {
    const { structure, number, side } = what.value;
    if (structure === Structure.RIB && number > 0) return `rib-${number}-${sideWord(side)}`;
    if (structure === Structure.VERTEBRA) return number > 12 ? `l${number - 12}` : `t${number}`;
    if (structure === Structure.LUNG && /^lung_(left|right)$/.test(name)) return `lung-${sideWord(side)}`;
  }
  return name.replaceAll("_", "-").replace("-lobe-", "-");
}

function otherNames(name: string): string {
  if (name === "ribs") return t("Ribs, all in one label");
  if (name === "costal_cartilages") return t("Costal cartilages, all in one label");
  return name === "sternum" ? t("Sternum") : name;
}

/** Returns what is missing in words. */
export function missingName({ structure, organ, side, numbers }: MissingStructure): string {
  const body = organs[organ];
  if (body !== undefined) return termsOf(body)[0].name;
  if (structure === Structure.LUNG) return termsOf(`lung-${sideWord(side)}`)[0].name;
  if (structure === Structure.VERTEBRA) return t("Vertebrae");
  if (structure === Structure.STERNUM_BODY) return t("Sternum");
  if (numbers.length === 0) return t("Ribs");
  const all = numbers.join(", ");
  return side === Side.LEFT ? t("Left ribs {0}", all) : t("Right ribs {0}", all);
}
