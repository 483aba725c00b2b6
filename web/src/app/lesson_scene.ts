import { fields } from "../appearance/fields";
import type { LayerStyles } from "../appearance/layer_styles";
import type { LessonView } from "../gen/phrenic/v1/lesson_pb";
import type { Session } from "../gen/phrenic/v1/session_pb";
import type { SceneNames } from "../session/lessons";
import type { Signal } from "../state/signal";
import { cutKinds } from "../viewer/clipping";
import { viewNames } from "../viewer/named_views";
import type { SceneTools } from "./scene_tools";

/** Returns the names that the lessons of a scene with these layers may use. */
export function sceneNames(scene: string, layers: string[]): SceneNames {
  const colourings = ["own", ...fields.map(({ kind }) => kind)];
  return { scene, cameras: viewNames, cuts: cutKinds, colourings, layers };
}

/** Resolves once the session and the layers of its scene are known. */
export function whenShown(session: Signal<Session | undefined>, { all }: LayerStyles): Promise<SceneNames> {
  return new Promise((resolve) => {
    const check = () => {
      if (session.value === undefined || all.value.length === 0) return;
      resolve(
        sceneNames(
          session.value.scene,
          all.value.map(({ layer }) => layer),
        ),
      );
    };
    session.subscribe(check);
    all.subscribe(check);
  });
}

/** Applies a step's view; unset fields change nothing. Requires: the names are those of `sceneNames`. */
export function showLessonView(
  { camera, cut, colouring, hiddenLayers }: LessonView,
  tools: SceneTools,
  layerStyles: LayerStyles,
): void {
  const view = viewNames.find((name) => name === camera);
  if (view !== undefined) tools.visit(view);
  const kind = cutKinds.find((name) => name === cut);
  if (kind !== undefined) tools.cut.set({ kind, fraction: 0.5, flipped: false });
  if (colouring !== "") tools.coloring.choose(fields.find((field) => field.kind === colouring)?.kind);
  for (const { layer, visible } of layerStyles.all.value) {
    const wanted = !hiddenLayers.includes(layer) && layerStyles.shownByScene(layer);
    if (visible !== wanted) layerStyles.change(layer, { visible: wanted });
  }
}
