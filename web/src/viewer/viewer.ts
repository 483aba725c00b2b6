import * as THREE from "three";
import type { Body, FrameArrays } from "../codec";
import { BodyView, type OverlayKind } from "./body_view";
import { addLights } from "./lights";
import { type Pull, Pulling } from "./pulling";
import { type Compass, type Covered, Rig } from "./rig";
import { Sharpness } from "./sharpness";
import type { ViewName } from "./views";

/** Scenes of at most so many vertices are diagrams rather than anatomy. */
const mostOfADiagram = 2000;

/**
 * The picture. It draws only when something changed, on the browser's own beat, so a hidden tab draws nothing and any
 * number of frames between two beats cost one drawing.
 */
export class Viewer {
  readonly rig: Rig;
  private readonly scene = new THREE.Scene();
  /** Depth by haze: what lies behind fades a little into the background. */
  private readonly haze = new THREE.Fog("#1f262d");
  private readonly renderer: THREE.WebGLRenderer;
  private views: BodyView[] = [];
  private readonly overlays = new Set<OverlayKind>();
  private readonly sharpness = new Sharpness(Math.min(devicePixelRatio, 2));
  private stale = true;
  private drawings = 0;
  private shown: FrameArrays | undefined;

  /**
   * `source` gives the newest frame when a picture is due; `drawn` hears of every picture; `covered` is how much
   * of the canvas panels hide. */
  constructor(
    private readonly canvas: HTMLCanvasElement,
    private readonly source: () => FrameArrays | undefined,
    private readonly drawn: (compass: Compass) => void,
    private readonly covered: () => Covered,
    calm: () => boolean,
  ) {
    this.renderer = new THREE.WebGLRenderer({
      canvas,
      antialias: true,
      alpha: true,
      powerPreference: "high-performance",
    });
    // No tone mapping: a layer has the colour that its swatch shows.
    this.renderer.toneMapping = THREE.NoToneMapping;
    this.renderer.setPixelRatio(this.sharpness.ratio);
    this.rig = new Rig(canvas, () => this.refresh(), calm);
    this.scene.fog = this.haze;
    addLights(this.scene, this.rig.camera);
    new ResizeObserver(() => this.resize()).observe(canvas);
    this.renderer.setAnimationLoop((now) => this.beat(now));
  }

  /** Pictures drawn so far. */
  get count(): number {
    return this.drawings;
  }

  show(bodies: Body[]): void {
    for (const view of this.views) {
      this.scene.remove(view.group);
      view.dispose();
    }
    this.shown = undefined;
    const diagram = verticesOf(bodies) <= mostOfADiagram;
    this.views = bodies.map((body) => new BodyView(body, diagram));
    for (const view of this.views) this.scene.add(view.group);
    for (const kind of this.overlays) this.setOverlay(kind, true);
    this.resize();
    this.rig.frame(sampleOf(bodies));
    this.refresh();
  }

  /** Draws at the next beat. */
  refresh(): void {
    this.stale = true;
  }

  setLayerOpacity(layer: string, opacity: number): void {
    for (const view of this.views) if (view.body.layer === layer) view.setOpacity(opacity);
    this.refresh();
  }

  setOverlay(kind: OverlayKind, on: boolean): void {
    if (on) this.overlays.add(kind);
    else this.overlays.delete(kind);
    for (const view of this.views) view.setOverlay(kind, on);
    this.refresh();
  }

  /** Paints one body, sRGB, three bytes a vertex, and no other; undefined leaves none painted. */
  paint(painted: { body: string; rgb: Uint8Array } | undefined): void {
    for (const view of this.views) view.paint(view.body.name === painted?.body ? painted.rgb : undefined);
    this.refresh();
  }

  /** Dragging with the shift key pulls at the visible ones among the bodies of these names from now on. */
  letPull(names: () => ReadonlySet<string>, pull: Pull): void {
    const views = () => this.views.filter(({ body, group }) => group.visible && names().has(body.name));
    new Pulling(this.canvas, this.rig.camera, this.scene, views, pull, () => this.refresh());
  }

  go(view: ViewName): void {
    this.rig.go(view);
  }

  /** Takes the canvas as it is now, and what panels leave of it. */
  resize(): void {
    const { clientWidth, clientHeight } = this.canvas;
    if (clientWidth === 0 || clientHeight === 0) return;
    this.renderer.setSize(clientWidth, clientHeight, false);
    this.rig.resize(this.covered());
    this.refresh();
  }

  private beat(now: number): void {
    this.rig.update(now);
    if (this.sharpness.beat(now, this.stale)) {
      this.renderer.setPixelRatio(this.sharpness.ratio);
      this.stale = true;
    }
    if (!this.stale) return;
    this.stale = false;
    const frame = this.source();
    if (frame !== undefined && frame !== this.shown) for (const view of this.views) view.update(frame);
    this.shown = frame;
    const { distance, extent } = this.rig.depth;
    [this.haze.near, this.haze.far] = [distance - 0.1 * extent, distance + 0.75 * extent];
    this.renderer.render(this.scene, this.rig.camera);
    this.drawings++;
    this.drawn(this.rig.compass());
  }
}

function verticesOf(bodies: Body[]): number {
  return bodies.reduce((sum, { rest }) => sum + rest.length / 3, 0);
}

/** Some thousands of vertices at rest, a fair sample of where the bodies are. */
function sampleOf(bodies: Body[]): THREE.Vector3[] {
  const stride = Math.max(1, Math.floor(verticesOf(bodies) / 4000));
  return bodies.flatMap(({ rest }) => {
    const points: THREE.Vector3[] = [];
    for (let i = 0; i < rest.length; i += 3 * stride) points.push(new THREE.Vector3(rest[i], rest[i + 1], rest[i + 2]));
    return points;
  });
}
