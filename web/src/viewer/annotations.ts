import { scaleLinear } from "d3-scale";
import * as THREE from "three";
import { planeAxes } from "./named_views";
import type { Names } from "./names";
import { paintSvg } from "./overlay_painter";
import type { Viewer } from "./viewer";

/** Mean character width [CSS pixels]. */
const letterWidth = 7.5;

/** Measured points and what is measured at them. */
export interface MeasuredPoints {
  /** Positions [m]: one for a surface, two for a distance, three for an angle, whose corner is the second. */
  places: [number, number, number][];
  color: string;
  label: string;
}

/** An SVG over the canvas with the leader lines of names, measurements and, for planar scenes, axes. */
export class Annotations {
  readonly element = svg("svg", { class: "annotations" });
  private readonly names = svg("g", { class: "names" });
  private readonly axes = svg("g", { class: "axes" });
  private readonly measures = svg("g", { class: "measures" });
  private measured: MeasuredPoints[] = [];

  constructor(
    private readonly viewer: Viewer,
    private readonly named: Names,
  ) {
    this.element.setAttribute("aria-hidden", "true");
    this.element.append(this.axes, this.measures, this.names);
  }

  /** Sets the measurements that the next drawing shows. */
  setMeasured(measured: MeasuredPoints[]): void {
    this.measured = measured;
  }

  /** Draws the annotations over a picture of the canvas. */
  paint(pen: CanvasRenderingContext2D, ratio: number): void {
    paintSvg(this.element, pen, ratio);
  }

  /** Updates the annotations to the current camera. */
  draw(): void {
    this.measures.replaceChildren(...this.measured.flatMap((each) => this.drawMeasured(each)));
    this.names.replaceChildren(...this.drawLeaders());
    this.axes.replaceChildren(...this.drawAxes());
  }

  private drawMeasured({ places, color, label }: MeasuredPoints): SVGElement[] {
    const ends = places.map((place) => this.viewer.rig.project(new THREE.Vector3(...place)));
    if (ends.length === 0) return [];
    const line = svg("polyline", { points: ends.map((end) => end.join(",")).join(" ") });
    line.style.stroke = color;
    // The label lies at the corner of an angle, and beside the middle of a distance.
    const at = ends.length === 2 ? [0, 1].map((k) => (ends[0][k] + ends[1][k]) / 2) : ends[ends.length >> 1];
    const side = at[0] + 9 + letterWidth * label.length > this.element.clientWidth ? -1 : 1;
    return [line, svgText(at[0] + 9 * side, at[1] - 9, label, side > 0 ? "start" : "end", color)];
  }

  private drawLeaders(): SVGElement[] {
    return this.named.leaders().flatMap(({ from, x, y }) => {
      const [cx, cy] = this.viewer.rig.project(from);
      return [svg("polyline", { points: `${cx},${cy} ${x},${y}` }), svg("circle", { cx, cy, r: 2.5 })];
    });
  }

  /** Axes are drawn only if the camera looks perpendicularly at the plane, so that lengths are true. */
  private drawAxes(): SVGElement[] {
    const { bounds, rig } = this.viewer;
    const plane = bounds.isEmpty() ? undefined : planeAxes(bounds);
    if (plane === undefined) return [];
    const [right, up] = plane;
    const [across, along] = rig.orientation().axes;
    if (across[right] < 0.9995 || along[up] < 0.9995) return [];
    const at = (x: number, y: number) => {
      const place = bounds.min.clone();
      place[right] = x;
      place[up] = y;
      return rig.project(place);
    };
    const { min } = bounds;
    const alongX = (value: number) => at(value, min[up]);
    const alongY = (value: number) => at(min[right], value);
    return [...ruler(bounds, right, alongX, true), ...ruler(bounds, up, alongY, false)];
  }
}

/** An axis along the bounding box with ticks [m]. */
function ruler(
  { min, max }: THREE.Box3,
  axis: "x" | "y" | "z",
  at: (value: number) => [number, number],
  across: boolean,
): SVGElement[] {
  const scale = scaleLinear([min[axis], max[axis]], [0, 1]);
  const [dx, dy] = across ? [0, 8] : [-8, 0];
  const outside = (value: number): [number, number] => {
    const [x, y] = at(value);
    return [x + 2 * dx, y + 2 * dy];
  };
  const parts: SVGElement[] = [line(outside(min[axis]), outside(max[axis]))];
  for (const tick of scale.ticks(6)) {
    const [x, y] = outside(tick);
    parts.push(line([x, y], [x + dx, y + dy]));
    const text = scale.tickFormat(6)(tick).replace("-", "−");
    parts.push(across ? svgText(x, y + 22, text, "middle") : svgText(x - 12, y + 4, text, "end"));
  }
  const [x, y] = outside(max[axis]);
  parts.push(across ? svgText(x + 14, y + 5, `${axis} [m]`, "start") : svgText(x, y - 10, `${axis} [m]`, "middle"));
  return parts;
}

function svg<K extends keyof SVGElementTagNameMap>(tag: K, attributes: Record<string, string | number>) {
  const element = document.createElementNS("http://www.w3.org/2000/svg", tag);
  for (const [name, value] of Object.entries(attributes)) element.setAttribute(name, String(value));
  return element;
}

function line([x1, y1]: [number, number], [x2, y2]: [number, number]): SVGElement {
  return svg("line", { x1, y1, x2, y2 });
}

function svgText(x: number, y: number, text: string, anchor: string, color?: string): SVGElement {
  const element = svg("text", { x, y, "text-anchor": anchor });
  if (color !== undefined) element.style.fill = color;
  element.textContent = text;
  return element;
}
