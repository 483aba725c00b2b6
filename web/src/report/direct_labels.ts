import { initializer, type Markish, text } from "@observablehq/plot";

/** A curve of a plot with its label. */
export interface LabelledLine {
  id: string;
  name: string;
  points: { x: number; y: number }[];
}

interface Point {
  x: number;
  y: number;
}
interface Box {
  left: number;
  top: number;
  right: number;
  bottom: number;
}
interface Placed {
  box: Box;
  cost: number;
}

const letterWidth = 7.7; // mean character width [px]
const labelHeight = 18; // label height [px]

/** Labels beside their curves, in the colours of the curves, where they cover the least. */
export function directLabels(lines: LabelledLine[], keepFree: { x: number; y: number }[] = []): Markish {
  const placeAll = initializer<{ frameAnchor: "middle" }>(
    { frameAnchor: "middle" },
    (data, facets, _channels, scales, dimensions) => {
      const onPage = (points: Point[]) => points.map(({ x, y }) => ({ x: scales.x!(x), y: scales.y!(y) }));
      const frame: Box = {
        left: dimensions.marginLeft,
        top: dimensions.marginTop,
        right: dimensions.width - dimensions.marginRight,
        bottom: dimensions.height - dimensions.marginBottom,
      };
      const boxes = placeLabels(
        lines.map(({ name, points }) => ({ name, points: onPage(points) })),
        onPage(keepFree),
        frame,
      );
      const channels = {
        x: { value: boxes.map(({ left }) => left + 3) },
        y: { value: boxes.map(({ top }) => top + labelHeight / 2) },
      };
      return { data, facets, channels };
    },
  );
  return text(lines, {
    ...placeAll,
    text: "name",
    fill: "id",
    stroke: "white",
    strokeWidth: 4,
    fontSize: 14,
    fontWeight: 600,
    textAnchor: "start",
    lineAnchor: "middle",
  });
}

/** Returns one box per curve [px], beside one of its points, where it covers the least. */
export function placeLabels(lines: { name: string; points: Point[] }[], keepFree: Point[], frame: Box): Box[] {
  const own = lines.map(({ points }) => samplePoints(points));
  const placed: Box[] = [];
  lines.forEach(({ name, points }, i) => {
    const others = [...own.flatMap((each, j) => (j === i ? [] : each)), ...keepFree];
    const best = points
      .flatMap((point, at) => candidateBoxes(point, letterWidth * name.length + 6).map((box) => ({ box, at })))
      .map(({ box, at }): Placed => {
        const fromEnd = Math.min(at, points.length - 1 - at);
        return { box, cost: placementCost(box, frame, placed, others, own[i]) + fromEnd };
      })
      .sort((a, b) => a.cost - b.cost)[0];
    placed.push(best?.box ?? { left: frame.left, top: frame.top, right: frame.left, bottom: frame.top });
  });
  return placed;
}

/** Returns points along a curve at small distances. */
function samplePoints(points: Point[]): Point[] {
  return points.flatMap((point, i) => {
    const next = points[i + 1];
    if (next === undefined) return [point];
    const steps = Math.max(1, Math.ceil(Math.hypot(next.x - point.x, next.y - point.y) / 6));
    const at = (k: number) => ({
      x: point.x + (k / steps) * (next.x - point.x),
      y: point.y + (k / steps) * (next.y - point.y),
    });
    return Array.from({ length: steps }, (_, k) => at(k));
  });
}

function candidateBoxes({ x, y }: Point, width: number): Box[] {
  const lefts = [x + 13, x - width - 13, x - width / 2];
  const tops = [y - labelHeight / 2, y - labelHeight - 9, y + 9, y - labelHeight - 22, y + 22];
  return lefts
    .flatMap((left) => tops.map((top) => ({ left, top, right: left + width, bottom: top + labelHeight })))
    .filter((box) => !(box.left < x && box.right > x && box.top < y && box.bottom > y));
}

function placementCost(box: Box, frame: Box, placed: Box[], others: Point[], own: Point[]): number {
  const outside =
    Math.max(0, frame.left - box.left) +
    Math.max(0, box.right - frame.right) +
    Math.max(0, frame.top - box.top) +
    Math.max(0, box.bottom - frame.bottom);
  const hidden = (points: Point[]) =>
    points.filter(({ x, y }) => x > box.left && x < box.right && y > box.top - 2 && y < box.bottom + 2).length;
  const over = placed.filter(
    (each) => each.left < box.right && each.right > box.left && each.top < box.bottom && each.bottom > box.top,
  ).length;
  return 50 * outside + 1000 * over + 8 * hidden(others) + 5 * hidden(own);
}
