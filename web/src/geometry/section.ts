/** A plane across an axis: 0 for x, 1 for y, 2 for z, at a coordinate [m]. */
export interface AxisPlane {
  axis: 0 | 1 | 2;
  at: number;
}

/** A picture that lies in a plane, where it cuts a closed surface. */
export interface SectionPicture extends AxisPlane {
  /** Lower corner along the two other axes, in the order y z, z x or x y [m]. */
  low: [number, number];
  /** Side of a pixel [m]. */
  step: number;
  width: number;
  height: number;
  /** sRGB and coverage of each pixel, row by row along the first of the two axes. */
  rgba: Uint8Array<ArrayBuffer>;
}

/** The two axes of a plane, so that both and its own axis are right-handed. */
export function axesOf(axis: 0 | 1 | 2): [number, number] {
  return [(axis + 1) % 3, (axis + 2) % 3];
}

/** Where lines of a plane are inside a closed surface: `spans[row]` has entries and exits along the first axis [m]. */
export interface Outline {
  low: [number, number];
  rows: number;
  spans: number[][];
  /** Largest coordinate along the first axis [m]. */
  end: number;
}

/** Cuts a surface by a plane, in lines `step` apart [m] along the second axis; undefined if the plane misses it. */
export function outlineOf(
  positions: ArrayLike<number>,
  triangles: ArrayLike<number>,
  { axis, at }: AxisPlane,
  step: number,
): Outline | undefined {
  const segments = segmentsOf(positions, triangles, axis, at);
  if (segments.length === 0) return undefined;
  const low: [number, number] = [Infinity, Infinity];
  const high = [-Infinity, -Infinity];
  segments.forEach((value, i) => {
    low[i % 2] = Math.min(low[i % 2], value);
    high[i % 2] = Math.max(high[i % 2], value);
  });
  const rows = Math.max(1, Math.ceil((high[1] - low[1]) / step));
  const spans: number[][] = Array.from({ length: rows }, () => []);
  for (let s = 0; s < segments.length; s += 4) addCrossings(segments.slice(s, s + 4), low[1], step, spans);
  for (const row of spans) row.sort((a, b) => a - b);
  return { low, rows, spans, end: high[0] };
}

/** Returns a, b of both ends of each piece of the cut, four numbers a piece. */
function segmentsOf(x: ArrayLike<number>, triangles: ArrayLike<number>, axis: 0 | 1 | 2, at: number): number[] {
  const [a, b] = axesOf(axis);
  const segments: number[] = [];
  for (let t = 0; t < triangles.length; t += 3) {
    const above = [0, 1, 2].map((k) => x[3 * triangles[t + k] + axis] >= at);
    if (above[0] === above[1] && above[1] === above[2]) continue;
    for (let k = 0; k < 3; k++) {
      const next = (k + 1) % 3;
      if (above[k] === above[next]) continue;
      const [from, to] = [3 * triangles[t + k], 3 * triangles[t + next]];
      const part = (at - x[from + axis]) / (x[to + axis] - x[from + axis]);
      segments.push(x[from + a] + part * (x[to + a] - x[from + a]), x[from + b] + part * (x[to + b] - x[from + b]));
    }
  }
  return segments;
}

/** Adds where a piece of the cut crosses the middle of each row. */
function addCrossings([a0, b0, a1, b1]: number[], low: number, step: number, spans: number[][]): void {
  const [from, to] = [Math.min(b0, b1), Math.max(b0, b1)];
  const first = Math.max(0, Math.ceil((from - low) / step - 0.5));
  for (let row = first; row < spans.length; row++) {
    const at = low + (row + 0.5) * step;
    if (at >= to) break; // half open, so that a crossing at an end counts once
    if (at < from) continue;
    spans[row].push(a0 + ((at - b0) / (b1 - b0)) * (a1 - a0));
  }
}

/** Paints an outline: `color` returns three sRGB bytes at the middle of a pixel [m]. */
export function paintSection(
  outline: Outline,
  { axis, at }: AxisPlane,
  step: number,
  color: (x: number, y: number, z: number) => readonly [number, number, number],
): SectionPicture {
  const { low, rows: height, spans, end } = outline;
  const width = Math.max(1, Math.ceil((end - low[0]) / step));
  const rgba = new Uint8Array(4 * width * height);
  const [a, b] = axesOf(axis);
  const point = [0, 0, 0];
  point[axis] = at;
  spans.forEach((row, j) => {
    point[b] = low[1] + (j + 0.5) * step;
    for (let s = 0; s + 1 < row.length; s += 2) {
      const [from, to] = [(row[s] - low[0]) / step, (row[s + 1] - low[0]) / step];
      for (let i = Math.max(0, Math.floor(from)); i < Math.min(width, to); i++) {
        const covered = Math.min(i + 1, to) - Math.max(i, from);
        point[a] = low[0] + (i + 0.5) * step;
        const pixel = 4 * (i + width * j);
        const rgb = color(point[0], point[1], point[2]);
        rgba[pixel] = rgb[0];
        rgba[pixel + 1] = rgb[1];
        rgba[pixel + 2] = rgb[2];
        rgba[pixel + 3] = Math.min(255, rgba[pixel + 3] + Math.round(255 * covered));
      }
    }
  });
  return { axis, at, low, step, width, height, rgba };
}
