import { sentenceCase } from "./names";

const units: Record<string, string> = { mm: "mm", m: "m", s: "s", ms: "ms", us: "µs", ns: "ns", j: "J" };
const words: Record<string, string> = { cpu: "CPU", rms: "RMS" };
const whole: Record<string, string> = {
  cpu_per_second: "CPU [s per s]",
  real_time: "Faster than real time",
  pareto: "Pareto front",
  bytes_per_frame: "Bytes per frame",
  mbit_per_second: "Mbit/s at 30 fps",
  order: "Measured order",
  case: "Case",
  p025: "2.5 %",
  p5: "5 %",
  p25: "25 %",
  p50: "Median",
  p75: "75 %",
  p95: "95 %",
  p975: "97.5 %",
  change_percent: "Change [%]",
  mean_size: "Mean size of the effects",
  predicted_share: "Predicted share of the variance",
};

/** Returns the heading of a column from the name of its field, with the unit at its end: "Error RMS [mm]". */
export function headingOf(field: string): string {
  const known = whole[field];
  if (known !== undefined) return known;
  const parts = field.split("_");
  const at = parts.findIndex((part, i) => part in units && (i + 1 === parts.length || parts[i + 1] === "per"));
  if (at < 0 || parts[at - 1] === "per") return sentenceCase(spell(parts));
  const name = sentenceCase(spell(parts.slice(0, at))) || "Time";
  return `${name} [${[units[parts[at]], ...parts.slice(at + 1)].join(" ")}]`;
}

function spell(parts: string[]): string {
  return parts.map((part) => words[part] ?? part).join("_");
}
