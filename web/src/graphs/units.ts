/** Units that people use, by the one on the wire. */
const displayUnits: Record<string, [name: string, factor: number]> = {
  m: ["mm", 1000],
  "m^3": ["l", 1000],
  "m^3/s": ["l/s", 1000],
};

/** The unit that people use for one of the wire, and how many of it that one is. */
export function displayUnit(unit: string): [name: string, factor: number] {
  return displayUnits[unit] ?? [unit, 1];
}
