import type { Preset } from "../gen/phrenic/v1/scene_pb";
import { presetGroups } from "./presets";

/** Groups of presets by what causes the breath. A group that is not listed is a cause of its own. */
const groupsOfCauses: Record<string, string[]> = {
  Healthy: ["Breathing patterns", "Manoeuvres"],
  Ill: ["Nerve and muscle", "Lungs and pleura", "Chest wall and abdomen"],
  Machine: ["Support"],
};

/** Returns the presets by cause, in the order of the table, and within a cause by group in its order. */
export function presetCauses(presets: Preset[]): Map<string, Preset[]> {
  const causes = new Map<string, Preset[]>();
  const known = presetGroups(presets);
  for (const [cause, groups] of Object.entries(groupsOfCauses)) {
    const members = groups.flatMap((name) => known.get(name) ?? []);
    if (members.length > 0) causes.set(cause, members);
  }
  const listed = new Set(Object.values(groupsOfCauses).flat());
  for (const [group, members] of known) {
    const cause = group || "Breaths";
    if (!listed.has(group)) causes.set(cause, [...(causes.get(cause) ?? []), ...members]);
  }
  return causes;
}
