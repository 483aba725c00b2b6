/** Pascals per centimetre of water. */
export const cmH2O = 98.0665;

/** Units of the user interface by SI unit. */
const displayUnits: Record<string, [name: string, factor: number]> = {
  m: ["mm", 1000],
  "m^3": ["l", 1000],
  "m^3/s": ["l/s", 1000],
};

/** Returns the unit of the user interface for an SI unit, and the factor to it. */
export function displayUnit(unit: string): [name: string, factor: number] {
  return displayUnits[unit] ?? [unit, 1];
}
