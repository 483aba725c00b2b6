import type { LayerStyles } from "../appearance/layer_styles";
import { NameLabels } from "../panels/view/name_labels";
import type { Signal } from "../state/signal";
import { Annotations } from "../viewer/annotations";
import type { Cut } from "../viewer/clipping";
import { Names } from "../viewer/names";
import type { Viewer } from "../viewer/viewer";
import type { SceneStructures } from "./scene_structures";

/** What determines the names beside a view. */
export interface NamedScene {
  structures: SceneStructures;
  layerStyles: LayerStyles;
  labels: Signal<boolean>;
  cut: Signal<Cut>;
}

/** Returns the annotations of a view, and the names beside it, which follow layers, cut and switch. */
export function namedAnnotations(
  viewer: Viewer,
  { structures, layerStyles, labels, cut }: NamedScene,
): { annotations: Annotations; nameLabels: HTMLElement } {
  const shown = new NameLabels((vertex) => structures.choose(vertex));
  const names = new Names(
    viewer,
    (ref) => structures.nameAt(ref),
    (layer) => layerStyles.get(layer)?.opacity ?? 1,
    (all) => shown.show(all),
  );
  labels.subscribe((on) => names.setOn(on));
  layerStyles.all.subscribe(() => names.restart());
  cut.subscribe(() => names.restart());
  return { annotations: new Annotations(viewer, names), nameLabels: shown.element };
}
