import type { Parameters } from "../gen/phrenic/v1/parameters_pb";
import type { ParameterName } from "./controls";

/** The parameters that make a breath what it is; all others are of the person who breathes it. */
const pattern: ReadonlySet<string> = new Set<ParameterName>([
  "breathLength",
  "inspiratoryShare",
  "pauseShare",
  "glottisShare",
  "waxing",
  "diaphragmActivation",
  "intercostalActivation",
  "expiratoryActivation",
  "airwayResistance",
  "airwayPressure",
  "ventilatorPressure",
  "airwayClosed",
]);

/** Returns the values that `now` has of those parameters of a preset that are of the person, not of the breath. */
export function withoutPattern(preset: Parameters, now: Parameters): Partial<Record<ParameterName, never>> {
  const kept = Object.keys(preset).filter((name) => !name.startsWith("$") && !pattern.has(name)) as ParameterName[];
  const values = kept.map((name) => [name, now[name]] as const).filter(([, value]) => value !== undefined);
  return Object.fromEntries(values) as Partial<Record<ParameterName, never>>;
}
