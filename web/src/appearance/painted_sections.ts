import type { FrameArrays } from "../geometry/bodies";
import type { AxisPlane, SectionPicture } from "../geometry/section";
import type { LungTissue } from "../lungs/lung_tissue";
import type { Coloring } from "./coloring";
import { tissueKindOf } from "./fields";

/** Returns pictures of the lungs in a cut, coloured as their surfaces; none unless these show a field of the tissue. */
export function paintedSections(
  lungs: LungTissue,
  coloring: Coloring,
  plane: AxisPlane | undefined,
  arrays: FrameArrays | undefined,
): SectionPicture[] {
  const kind = tissueKindOf(coloring.field.value);
  const scale = coloring.scale.value;
  if (kind === undefined || scale === undefined || plane === undefined || arrays === undefined) return [];
  return lungs.sections(kind, plane, arrays, (value) => scale.color(value));
}
