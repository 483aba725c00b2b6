/** A point that gets a label if there is room [CSS pixels]. */
export interface LabelAnchor {
  x: number;
  y: number;
  /** Points of larger weight get labels first. */
  weight: number;
}

/** The area between two columns of labels [CSS pixels]: leader lines end at its left or right edge. */
export interface LabelFrame {
  left: number;
  right: number;
  top: number;
  bottom: number;
}

/** Where the leader line of a label ends, at half the label's height [CSS pixels]. */
export interface LabelPlace {
  side: "left" | "right";
  x: number;
  y: number;
}

/**
 * Places labels left and right of a scene (boundary labelling, Bekos et al. 2007): a vertical line divides the points,
 * labels of one side keep the order of their points as far as possible, are `spacing` apart, and lines do not cross.
 * Returns a place for each point; undefined for points left or right of the frame and for the lightest ones if not all
 * fit.
 */
export function placeLabels(
  anchors: readonly LabelAnchor[],
  frame: LabelFrame,
  spacing: number,
): (LabelPlace | undefined)[] {
  const places: (LabelPlace | undefined)[] = anchors.map(() => undefined);
  const capacity = Math.max(0, Math.floor((frame.bottom - frame.top) / spacing));
  const chosen = anchors
    .map((_, i) => i)
    .filter((i) => anchors[i].x >= frame.left && anchors[i].x <= frame.right)
    .sort((i, k) => anchors[k].weight - anchors[i].weight)
    .slice(0, 2 * capacity)
    .sort((i, k) => anchors[i].x - anchors[k].x);
  const middle = (frame.left + frame.right) / 2;
  const wanted = chosen.filter((i) => anchors[i].x < middle).length;
  const count = Math.min(capacity, Math.max(chosen.length - capacity, wanted));
  for (const [side, x, own] of [
    ["left", frame.left, chosen.slice(0, count)],
    ["right", frame.right, chosen.slice(count)],
  ] as const) {
    const heights = heightsOf(
      own.map((i) => anchors[i]),
      x,
      frame,
      spacing,
    );
    own.forEach((i, k) => (places[i] = { side, x, y: heights[k] }));
  }
  return places;
}

/** Returns the heights of the labels of one side, whose lines end at `x`. */
function heightsOf(anchors: LabelAnchor[], x: number, { top, bottom }: LabelFrame, spacing: number): number[] {
  const order = anchors.map((_, i) => i).sort((i, k) => anchors[i].y - anchors[k].y);
  const slots = pushedApart(
    order.map((i) => anchors[i].y),
    top + spacing / 2,
    bottom - spacing / 2,
    spacing,
  );
  const heights: number[] = [];
  order.forEach((i, k) => (heights[i] = slots[k]));
  uncross(anchors, heights, x);
  return heights;
}

/** Returns ascending heights that are `spacing` apart and between two limits, near the wanted ones. */
function pushedApart(wanted: number[], low: number, high: number, spacing: number): number[] {
  const heights = [...wanted];
  for (let i = 0; i < heights.length; i++) heights[i] = Math.max(heights[i], i > 0 ? heights[i - 1] + spacing : low);
  let limit = high;
  for (let i = heights.length - 1; i >= 0; i--, limit -= spacing) heights[i] = Math.min(heights[i], limit);
  return heights;
}

/**
 * Exchanges the heights of labels whose lines cross. Each exchange shortens the lines in total (the diagonals of a
 * quadrilateral are longer than two opposite sides), so that it ends.
 */
function uncross(anchors: LabelAnchor[], heights: number[], x: number): void {
  for (let crossed = true; crossed;) {
    crossed = false;
    for (let i = 0; i < anchors.length; i++) {
      for (let k = i + 1; k < anchors.length; k++) {
        if (!linesCross(anchors[i], { x, y: heights[i] }, anchors[k], { x, y: heights[k] })) continue;
        [heights[i], heights[k]] = [heights[k], heights[i]];
        crossed = true;
      }
    }
  }
}

/** A point on the screen [CSS pixels]. */
interface Place {
  x: number;
  y: number;
}

/** True if the inner points of two line segments cross. */
export function linesCross(a: Place, b: Place, c: Place, d: Place): boolean {
  return sideOf(a, b, c) * sideOf(a, b, d) < 0 && sideOf(c, d, a) * sideOf(c, d, b) < 0;
}

/** Returns -1, 0 or 1: the side of the line from `a` to `b` on which `p` lies. */
function sideOf(a: Place, b: Place, p: Place): number {
  return Math.sign((b.x - a.x) * (p.y - a.y) - (b.y - a.y) * (p.x - a.x));
}
