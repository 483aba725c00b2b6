import type { Body, FrameArrays } from "../geometry/bodies";
import { positionsOf } from "../geometry/bodies";
import { Placement } from "../gen/phrenic/v1/frames_pb";
import { type CArm, isMirrored, pictureOf, type Projection, sideLetters } from "./c_arm";
import { domeColors } from "./sniff_plot";
import { type SniffResult } from "./sniff_test";
import { svg } from "./svg";

/** Each dome's summit is a vertex that is further from the middle than this [m], as in the scene's measures. */
const fromMiddle = 0.035;
/** Half the length of a mark, in halves of the picture. */
const reach = 0.17;

/** What is drawn over the picture. */
export interface Marked {
  arm: CArm;
  projection: Projection;
  diaphragm: Body | undefined;
  frame: FrameArrays;
  /** True to mark the domes; with a result also where they were before the sniff. */
  domes: boolean;
  result: SniffResult | undefined;
}

/** Draws the sides' letters, a scale, and each dome's height now and before a sniff over a picture from -1 to 1. */
export function drawMarks(overlay: SVGSVGElement, { arm, projection, diaphragm, frame, domes, result }: Marked): void {
  const [left, right] = sideLetters(arm);
  const centimetres = 0.05 / projection.halfWidth;
  const pixel = 2 / Math.max(1, overlay.clientWidth);
  const [large, small] = [Math.max(0.11, 18 * pixel), Math.max(0.06, 13 * pixel)];
  overlay.setAttribute("font-size", String(small));
  overlay.replaceChildren(
    svg("text", { x: -0.95, y: -0.86, class: "side", "font-size": large }, left),
    svg("text", { x: 0.95, y: -0.86, class: "side", "font-size": large, "text-anchor": "end" }, right),
    svg("line", { x1: 0.94 - centimetres, x2: 0.94, y1: 0.95, y2: 0.95, class: "scale-line" }),
    svg("text", { x: 0.94, y: 0.91, class: "scale-words", "text-anchor": "end" }, "5 cm"),
  );
  if (!domes || diaphragm === undefined) return;
  const positions = diaphragm.placement === Placement.STREAMED ? positionsOf(diaphragm, frame) : diaphragm.rest;
  const mirrored = isMirrored(arm);
  for (const [name, side] of [
    ["right", -1],
    ["left", 1],
  ] as const) {
    // prettier-ignore
    const now = summit(positions, side);
    const [x, y] = pictureOf(now, projection, mirrored);
    overlay.append(mark(x, y, domeColors[name], false));
    if (result === undefined) continue;
    const rest = summit(diaphragm.rest, side);
    const [x0, y0] = pictureOf([rest[0], rest[1], rest[2] + result.before[name]], projection, mirrored);
    overlay.append(mark(x0, y0, domeColors[name], true), excursion(x0, y0, 1000 * result[name], name));
  }
}

function mark(x: number, y: number, color: string, dashed: boolean): SVGLineElement {
  const dashes = dashed ? "0.03 0.02" : "none";
  const ends = { x1: x - reach, x2: x + reach, y1: -y, y2: -y };
  return svg("line", { ...ends, stroke: color, "stroke-width": 0.008, "stroke-dasharray": dashes });
}

/** Words above a mark, which run away from the middle of the picture. */
function excursion(x: number, y: number, mm: number, name: "right" | "left"): SVGTextElement {
  const words = `${Math.abs(mm).toFixed(0)} mm ${mm < 0 ? "↓" : "↑"}`;
  const anchor = x < 0 ? "end" : "start";
  return svg("text", { x, y: -y - 0.04, fill: domeColors[name], class: "excursion", "text-anchor": anchor }, words);
}

/** Returns the highest vertex on one side, -1 for the right [m]. */
export function summit(positions: Float32Array, side: number): [number, number, number] {
  let top = -1;
  for (let i = 0; i < positions.length; i += 3) {
    if (side * positions[i] > fromMiddle && (top < 0 || positions[i + 2] > positions[top + 2])) top = i;
  }
  return top < 0 ? [NaN, NaN, NaN] : [positions[top], positions[top + 1], positions[top + 2]];
}
