import type { Preset } from "../gen/phrenic/v1/scene_pb";

/** Groups of presets by what causes the breath. A group that is not listed is a cause of its own. */
const groupsOfCauses: Record<string, string[]> = {
  Healthy: ["Breathing patterns", "Manoeuvres"],
  Ill: ["Nerve and muscle", "Lungs and pleura", "Chest wall and abdomen"],
  Machine: ["Support"],
};

/** Returns the presets by cause, in the order of the table, and within a cause by group in its order. */
export function presetCauses(presets: Preset[]): Map<string, Preset[]> {
  const causes = new Map<string, Preset[]>();
  for (const [cause, groups] of Object.entries(groupsOfCauses)) {
    const members = groups.flatMap((name) => presets.filter(({ group }) => group === name));
    if (members.length > 0) causes.set(cause, members);
  }
  const listed = new Set(Object.values(groupsOfCauses).flat());
  for (const preset of presets.filter(({ group }) => !listed.has(group))) {
    const cause = preset.group || "Breaths";
    causes.set(cause, [...(causes.get(cause) ?? []), preset]);
  }
  return causes;
}
