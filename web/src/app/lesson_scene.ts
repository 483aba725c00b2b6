import { create } from "@bufbuild/protobuf";
import { fields, tissueFields } from "../appearance/fields";
import type { LayerStyles } from "../appearance/layer_styles";
import type { Frame } from "../gen/phrenic/v1/frames_pb";
import { type LessonMeasurement, type LessonView, LessonViewSchema } from "../gen/phrenic/v1/lesson_pb";
import type { Session } from "../gen/phrenic/v1/session_pb";
import type { KeptMeasurement } from "../geometry/measuring";
import { predictionSubjects } from "../graphs/student_graphs";
import type { SceneNames } from "../session/lessons";
import type { Signal } from "../state/signal";
import { cutKinds } from "../viewer/clipping";
import { viewNames } from "../viewer/named_views";
import type { SceneTools } from "./scene_tools";

/** The fields that a step may show. */
const colourable = [...fields, ...tissueFields];

/** Returns the names that the lessons of a scene with these layers, predicted measures and bodies may use. */
export function sceneNames(scene: string, layers: string[], predicted: string[], bodies: string[] = []): SceneNames {
  const colourings = ["own", ...colourable.map(({ kind }) => kind)];
  return { scene, cameras: viewNames, cuts: cutKinds, colourings, layers, predicted, bodies };
}

/** Resolves once the session, the layers of its scene and its measures are known. */
export async function whenShown(
  session: Signal<Session | undefined>,
  styles: LayerStyles,
  first: Promise<Frame>,
): Promise<SceneNames> {
  const { all } = styles;
  const predicted = predictionSubjects(await first).map(({ measure }) => measure);
  return new Promise((resolve) => {
    const check = () => {
      if (session.value === undefined || all.value.length === 0) return;
      resolve(
        sceneNames(
          session.value.scene,
          all.value.map(({ layer }) => layer),
          predicted,
          styles.bodyNames,
        ),
      );
    };
    session.subscribe(check);
    all.subscribe(check);
  });
}

/** Applies a step's view; unset fields change nothing. Requires: the names are those of `sceneNames`. */
export function showLessonView(
  { camera, cut, colouring, hiddenLayers, pose, cutPosition, cutFlipped, colourTop, measurements }: LessonView,
  tools: SceneTools,
  layerStyles: LayerStyles,
): void {
  const view = viewNames.find((name) => name === camera);
  if (view !== undefined) tools.visit(view);
  const { eye, target } = pose ?? {};
  if (eye !== undefined && target !== undefined) tools.lookFrom({ eye, target });
  const kind = cutKinds.find((name) => name === cut);
  if (kind !== undefined) tools.cut.set({ kind, fraction: cutPosition ?? 0.5, flipped: cutFlipped });
  if (colouring !== "") tools.coloring.choose(colourable.find((field) => field.kind === colouring)?.kind);
  if (colourTop !== undefined) tools.coloring.setTop(colourTop);
  for (const { layer, visible } of layerStyles.all.value) {
    const wanted = !hiddenLayers.includes(layer) && layerStyles.shownByScene(layer);
    if (visible !== wanted) layerStyles.change(layer, { visible: wanted });
  }
  tools.measuring.measurements.replaceKept(measurements.map(keptOf));
}

function keptOf({ tool, points }: LessonMeasurement): KeptMeasurement {
  const places = points.map(({ body, rest }) => ({ body, rest: [rest!.x, rest!.y, rest!.z] as const }));
  return { tool: tool as KeptMeasurement["tool"], points: places };
}

function inLesson({ tool, points }: KeptMeasurement) {
  return { tool: tool as string, points: points.map(({ body, rest: [x, y, z] }) => ({ body, rest: { x, y, z } })) };
}

/** Returns what is shown now as the view of a step. */
export function keptLessonView(tools: SceneTools, layerStyles: LayerStyles): LessonView {
  const { kind, fraction, flipped } = tools.cut.value;
  const colouring = colourable.find((each) => each.kind === tools.coloring.field.value)?.kind ?? "own";
  const hidden = layerStyles.all.value.filter(({ layer, visible }) => !visible && layerStyles.shownByScene(layer));
  return create(LessonViewSchema, {
    pose: tools.pose,
    cut: kind,
    ...(kind === "none" ? {} : { cutPosition: fraction, cutFlipped: flipped }),
    colouring,
    colourTop: tools.coloring.scale.value?.top,
    hiddenLayers: hidden.map(({ layer }) => layer),
    measurements: tools.measuring.measurements.kept().map(inLesson),
  });
}
