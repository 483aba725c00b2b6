import type { OfflineMotion } from "../gen/phrenic/v1/offline_pb";
import { type Parameters, ParametersSchema } from "../gen/phrenic/v1/parameters_pb";
import type { Preset } from "../gen/phrenic/v1/scene_pb";
import type { ParameterName } from "./controls";
import { t } from "../language/translate";

/** Returns the title, or the name as words if there is none: "paralysis-right" as "Paralysis right". */
export function presetLabel({ name, title }: Preset): string {
  return t(title) || name.charAt(0).toUpperCase() + name.slice(1).replaceAll("-", " ");
}

/** Returns the presets by group, in the order in which the scene names the groups first. */
export function presetGroups(presets: Preset[]): Map<string, Preset[]> {
  const groups = new Map<string, Preset[]>();
  for (const preset of presets) groups.set(preset.group, [...(groups.get(preset.group) ?? []), preset]);
  return groups;
}

/** Returns the first preset that is active. */
export function activePreset(presets: Preset[], parameters: Parameters | undefined): Preset | undefined {
  return parameters === undefined ? undefined : presets.find((preset) => isActive(preset, parameters));
}

/** Returns the label of the active preset; undefined if none is active. */
export function activeLabel(presets: Preset[], parameters: Parameters | undefined): string | undefined {
  const active = activePreset(presets, parameters);
  return active && presetLabel(active);
}

/** Returns the title of a motion: that of its scene, and the preset if one is active. */
export function motionTitle(motion: OfflineMotion): { scene: string; preset: string } {
  const active = activePreset(motion.presets, motion.parameters);
  return { scene: t(motion.sceneTitle) || motion.scene, preset: active === undefined ? "" : presetLabel(active) };
}

/** True if all parameters that the preset sets have its values. */
export function isActive(preset: Preset, parameters: Parameters): boolean {
  return ParametersSchema.fields.every((field) => {
    const name = field.localName as ParameterName;
    const wanted = preset.parameters?.[name];
    return wanted === undefined || wanted === parameters[name];
  });
}
