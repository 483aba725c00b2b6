import { create, equals } from "@bufbuild/protobuf";
import { type Parameters, ParametersSchema } from "../gen/phrenic/v1/parameters_pb";
import type { Preset } from "../gen/phrenic/v1/scene_pb";
import { activePreset } from "./presets";

type Values = Record<string, unknown>;

/** A breath as a lesson names it: a preset, and the parameters that differ from what it gives. */
export interface KeptBreath {
  preset: string;
  parameters: Parameters | undefined;
}

/**
 * Returns how to set `current` again in a session of the scene with these parameters: by the active preset, or by the
 * first one and all that differs.
 */
export function keptBreath(presets: Preset[], ofScene: object | undefined, current: Parameters): KeptBreath {
  const preset = activePreset(presets, current) ?? presets[0];
  const before = { ...ofScene, ...definedOf(preset?.parameters) } as unknown as Values;
  const differing = create(ParametersSchema);
  for (const { localName } of ParametersSchema.fields) {
    const value = (current as unknown as Values)[localName];
    if (value !== undefined && value !== before[localName]) (differing as unknown as Values)[localName] = value;
  }
  const none = equals(ParametersSchema, differing, create(ParametersSchema));
  return { preset: preset?.name ?? "", parameters: none ? undefined : differing };
}

/** The fields that are set. */
function definedOf(parameters: Parameters | undefined): Values {
  const entries = Object.entries((parameters ?? {}) as Values);
  return Object.fromEntries(entries.filter(([name, value]) => value !== undefined && !name.startsWith("$")));
}
