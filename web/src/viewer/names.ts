import * as THREE from "three";
import { type LabelPlace, placeLabels } from "../geometry/boundary_labels";
import { frontVertices, type ScreenSurface } from "../geometry/front_vertices";
import type { VertexRef } from "../geometry/vertices";
import type { BodyView } from "./body_view";
import type { Viewer } from "./viewer";

/** The name of what is seen at a vertex. */
export interface Name {
  name: string;
  /** Empty if it has none. */
  latin: string;
  /** True for a structure, which can be chosen; false for a layer. */
  structure: boolean;
}

/** A name beside the scene. */
export interface NameLabel extends Name, LabelPlace {
  /** A vertex of it that is seen. */
  ref: VertexRef;
  /** Room for the text [CSS pixels]. */
  width: number;
  height: number;
}

/** A line from a vertex to its label. */
export interface Leader extends LabelPlace {
  /** Position of the vertex [m]. */
  from: THREE.Vector3;
}

/** Pixels of the depth buffer are this large [CSS pixels]; fewer than so many pixels get no name. */
const pixel = 4;
const fewest = 6;
/** The camera rests after this time [ms] with changes of its matrix by rounding only. */
const restTime = 250;
const still = 1e-4;
/** Room for the letters at the edges of the view, and for bar and cube at its top [CSS pixels]. */
const [edge, head] = [30, 76];
/** Heights of labels of two lines, and of three in a column narrower than this [CSS pixels]. */
const [twoLines, threeLines, narrow] = [36, 45, 88];
/** How far labels reach above and below the points [CSS pixels]. */
const reach = 60;

/**
 * Returns the width of a column of names in a free part of the canvas that is this wide, with its edge [CSS pixels].
 */
export function nameColumn(width: number): number {
  return edge + Math.min(0.25 * width, 190);
}

/** Names the structures that are seen, in two columns beside the scene. They are hidden while the camera moves. */
export class Names {
  private on = false;
  private labels: NameLabel[] = [];
  private readonly seen = new THREE.Matrix4();
  private timer: ReturnType<typeof setTimeout> | undefined;

  /** `show` is called with other labels; `opacityOf` returns the opacity of a layer. */
  constructor(
    private readonly viewer: Viewer,
    private readonly nameAt: (ref: VertexRef) => Name | undefined,
    private readonly opacityOf: (layer: string) => number,
    private readonly show: (labels: NameLabel[]) => void,
  ) {}

  /** Shows or hides the names. */
  setOn(on: boolean): void {
    this.on = on;
    this.restart();
  }

  /** Hides the names, and places them again a moment later. */
  restart(): void {
    clearTimeout(this.timer);
    if (this.labels.length > 0) this.change([]);
    if (this.on) this.timer = setTimeout(() => this.place(), restTime);
  }

  /** Returns the lines to the labels for the current frame; none while the camera moves. */
  leaders(): Leader[] {
    if (!this.on) return [];
    const { camera } = this.viewer.rig;
    const now = camera.projectionMatrix.clone().multiply(camera.matrixWorldInverse);
    if (now.elements.some((value, i) => Math.abs(value - this.seen.elements[i]) > still)) {
      this.seen.copy(now);
      this.restart();
    }
    return this.labels.map((label) => ({ ...label, from: this.placeOf(label.ref) }));
  }

  private change(labels: NameLabel[]): void {
    this.labels = labels;
    this.show(labels);
    this.viewer.refresh();
  }

  private placeOf({ body, vertex }: VertexRef): THREE.Vector3 {
    const view = this.viewer.bodies.find((each) => each.body.name === body);
    if (view === undefined) return new THREE.Vector3();
    return new THREE.Vector3().fromBufferAttribute(view.positions, vertex).applyMatrix4(view.group.matrixWorld);
  }

  private place(): void {
    const { left, right, top, bottom } = this.viewer.freePart;
    const column = nameColumn(right - left);
    const found = this.visibleNames().flatMap((each) => {
      const [x, y] = this.viewer.rig.project(this.placeOf(each.ref));
      return y < 0 || y > bottom ? [] : [{ ...each, anchor: { x, y, weight: each.count } }];
    });
    const anchors = found.map(({ anchor }) => anchor);
    const heights = anchors.map(({ y }) => y);
    const width = column - edge;
    const height = width < narrow ? threeLines : twoLines;
    const first = Math.max(top, head, Math.min(...heights) - reach);
    const last = Math.min(bottom - 6, Math.max(...heights, first) + reach);
    const frame = { left: left + column, right: right - column, top: first, bottom: last };
    const places = placeLabels(anchors, frame, height);
    const labels = found.flatMap(({ name, ref }, i): NameLabel[] => {
      const place = places[i];
      return place === undefined ? [] : [{ ...name, ...place, ref, width, height }];
    });
    // Tab goes down the left column, then down the right one.
    this.change(labels.sort((a, b) => a.side.localeCompare(b.side) || a.y - b.y));
  }

  /** Returns what is seen, the number of pixels, and the vertex that is nearest to the middle of these. */
  private visibleNames(): { name: Name; ref: VertexRef; count: number }[] {
    const views = this.viewer.bodies.filter(({ group, isFaded }) => group.visible && !isFaded);
    const [width, height] = this.viewer.size.map((length) => Math.ceil(length / pixel));
    const surfaces = views.map((view) => this.onScreen(view));
    const parts = new Map<string, { name: Name; pixels: { x: number; y: number; ref: VertexRef }[] }>();
    for (const { x, y, surface, vertex } of frontVertices(surfaces, width, height)) {
      const ref = { body: views[surface].body.name, vertex };
      const name = this.nameAt(ref);
      if (name === undefined) continue;
      const part = parts.get(name.name) ?? { name, pixels: [] };
      parts.set(name.name, part);
      part.pixels.push({ x, y, ref });
    }
    return [...parts.values()].flatMap(({ name, pixels }) => {
      const count = pixels.length;
      const enough = count >= fewest || !name.structure;
      return enough ? [{ name, count, ref: middleOf(pixels).ref }] : [];
    });
  }

  private onScreen({ body, positions, group }: BodyView): ScreenSurface {
    const { camera } = this.viewer.rig;
    const toScreen = camera.projectionMatrix.clone().multiply(camera.matrixWorldInverse);
    const places = new Float32Array(body.rest.length);
    const [width, height] = this.viewer.size;
    const place = new THREE.Vector3();
    for (let i = 0; i < positions.count; i++) {
      place.fromBufferAttribute(positions, i).applyMatrix4(group.matrixWorld);
      const clipped = this.viewer.isClipped(place);
      place.applyMatrix4(toScreen);
      // Behind the camera the depth is above 1.
      if (clipped || place.z > 1) places.fill(NaN, 3 * i, 3 * i + 3);
      else places.set([((place.x + 1) / 2) * (width / pixel), ((1 - place.y) / 2) * (height / pixel), place.z], 3 * i);
    }
    return { places, triangles: body.triangles, opaque: this.opacityOf(body.layer) >= 0.99 };
  }
}

/** Returns the pixel that is nearest to the mean of all. */
function middleOf<P extends { x: number; y: number }>(pixels: P[]): P {
  const mean = (along: "x" | "y") => pixels.reduce((sum, each) => sum + each[along], 0) / pixels.length;
  const [x, y] = [mean("x"), mean("y")];
  const away = (each: P) => (each.x - x) ** 2 + (each.y - y) ** 2;
  return pixels.reduce((best, each) => (away(each) < away(best) ? each : best));
}
