import type { StabilityRow } from "../gen/phrenic/v1/study_results_pb";

/** A rectangle around one run of the map, on logarithmic axes. */
export interface Cell {
  x: number;
  y: number;
  x1: number;
  x2: number;
  y1: number;
  y2: number;
  row: StabilityRow;
}

/** Returns cells that meet at the geometric mean of neighbouring values. */
export function cellsOf(points: { x: number; y: number; row: StabilityRow }[]): Cell[] {
  const rows = sortedSet(points.map(({ y }) => y));
  const borders = edgesOf(rows);
  return rows.flatMap((y, i) => {
    const own = points.filter((point) => point.y === y).sort((a, b) => a.x - b.x);
    const edges = edgesOf(own.map(({ x }) => x));
    return own.map((point, j) => ({
      ...point,
      x1: edges[j],
      x2: edges[j + 1],
      y1: borders[i],
      y2: borders[i + 1],
    }));
  });
}

/**
 * Returns the cell borders of ascending values, one more than values. The cell of a single value extends by a factor of
 * sqrt(2).
 */
export function edgesOf(values: number[]): number[] {
  const inner = values.slice(1).map((value, i) => Math.sqrt(value * values[i]));
  const first = values[0] ** 2 / (inner[0] ?? values[0] * Math.SQRT2);
  const last = values[values.length - 1];
  return [first, ...inner, last ** 2 / (inner[inner.length - 1] ?? last / Math.SQRT2)];
}

function sortedSet(values: number[]): number[] {
  return [...new Set(values)].sort((a, b) => a - b);
}
