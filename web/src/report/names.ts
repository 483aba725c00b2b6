import type { SymbolImplementation, SymbolType } from "@observablehq/plot";

/** The style of a series in all plots; series never differ by colour alone. */
export interface SeriesStyle {
  name: string;
  color: string;
  symbol: SymbolType | SymbolImplementation;
}

// A triangle that points down.
const down: SymbolImplementation = {
  draw(context: CanvasPath, size: number) {
    const r = Math.sqrt(size) * 0.88;
    context.moveTo(0, r);
    context.lineTo(r * 0.87, -r / 2);
    context.lineTo(-r * 0.87, -r / 2);
    context.closePath();
  },
};

// Dark enough for text on white (WCAG AA), and distinguishable for colour-blind people.
const styles: [string, string, string, SeriesStyle["symbol"]][] = [
  ["semi_implicit_euler", "Semi-implicit Euler", "#00609f", "circle"],
  ["thesis", "Thesis", "#b23a12", down],
  ["explicit_euler", "Explicit Euler", "#7d5600", "triangle"],
  ["velocity_verlet", "Velocity Verlet", "#00704c", "square"],
  ["runge_kutta_4", "Runge-Kutta 4", "#6f3fa0", "diamond"],
  ["linear_implicit_euler", "Linear-implicit Euler", "#a8216b", "hexagon"],
  ["bdf2", "BDF2", "#3d4650", "star"],
  ["tr_bdf2", "TR-BDF2", "#0b6f7d", "cross"],
  ["projective_dynamics", "Projective dynamics", "#8f4a1e", "wye"],
];

const known = new Map(styles.map(([id, name, color, symbol]) => [id, { name, color, symbol }]));

/** Returns the style of each series; unknown series get unused styles. */
export function seriesStyles(ids: Iterable<string>): Map<string, SeriesStyle> {
  const all = [...new Set(ids)];
  const free = styles.filter(([id]) => !all.includes(id)).map(([, , color, symbol]) => ({ color, symbol }));
  return new Map(
    all.map((id): [string, SeriesStyle] => {
      const next = known.has(id) ? undefined : (free.shift() ?? { color: "#222222", symbol: "plus" as const });
      return [id, known.get(id) ?? { name: sentenceCase(id), ...next! }];
    }),
  );
}

/** Returns the name of a series; text after a comma is kept: "Velocity Verlet, guarded". */
export function seriesName(id: string): string {
  const [series, ...rest] = id.split(", ");
  return [known.get(series)?.name ?? sentenceCase(series), ...rest].join(", ");
}

/** Replaces the ids of known series in a sentence by their names. */
export function withSeriesNames(sentence: string): string {
  return sentence.replace(/\b[a-z]+(?:_[a-z0-9]+)+\b/g, (word) => known.get(word)?.name ?? word);
}

/** Formats "velocity_verlet" as "Velocity verlet". */
export function sentenceCase(id: string): string {
  const words = id.replaceAll("_", " ").trim();
  return words.charAt(0).toUpperCase() + words.slice(1);
}
