import type { FieldKind } from "../appearance/fields";
import type { LayerStyles } from "../appearance/layer_styles";
import type { LessonView } from "../gen/phrenic/v1/lesson_pb";
import type { CutKind } from "../viewer/clipping";
import type { ViewName } from "../viewer/named_views";
import type { SceneTools } from "./scene_tools";

/** Applies a step's view; unset fields change nothing. */
export function showLessonView(
  { camera, cut, colouring, hiddenLayers }: LessonView,
  tools: SceneTools,
  layerStyles: LayerStyles,
): void {
  if (camera !== "") tools.lookFrom(camera as ViewName);
  if (cut !== "") tools.cut.set({ kind: cut as CutKind, fraction: 0.5, flipped: false });
  if (colouring !== "") tools.coloring.choose(colouring === "own" ? undefined : (colouring as FieldKind));
  for (const { layer, visible } of layerStyles.all.value) {
    const wanted = !hiddenLayers.includes(layer) && layerStyles.shownByScene(layer);
    if (visible !== wanted) layerStyles.change(layer, { visible: wanted });
  }
}
