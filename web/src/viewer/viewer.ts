import * as THREE from "three";
import type { Body, FrameArrays } from "../geometry/bodies";
import type { Surface } from "../geometry/surface";
import { type Marker, type VertexRef } from "../geometry/vertices";
import { Sharpness } from "./adaptive_resolution";
import { BodyView } from "./body_view";
import { type Compass, type Covered, Rig } from "./camera_rig";
import { letClick } from "./click_picking";
import { type Cut, placeOf, planeOf } from "./clipping";
import { Ghost } from "./ghost";
import { addLights } from "./lights";
import { Markers } from "./markers";
import type { ViewName } from "./named_views";
import { type OverlayKind, overlayKinds } from "./overlays";
import { type Pull, Pulling } from "./pulling";

/** Scenes of at most so many vertices are diagrams rather than anatomy. */
const mostOfADiagram = 2000;
/** Radius of a marker [CSS pixels]. */
const markerSize = 5;

/** What a picture asks of its page. */
export interface Surroundings {
  /** Goes on to the moment that is due; whether the picture changes by it. */
  advance(): boolean;
  /** That moment. */
  source(): FrameArrays | undefined;
  /** Hears of a frame before it is drawn for the first time. */
  update?(frame: FrameArrays): void;
  /** Hears of every picture. */
  drawn(compass: Compass): void;
  /** How much of the canvas panels hide. */
  covered(): Covered;
  /** Whether the person asked for less motion. */
  calm(): boolean;
}

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
  private overlays: ReadonlySet<OverlayKind> = new Set();
  private readonly sharpness = new Sharpness(Math.min(devicePixelRatio, 2));
  private readonly ghost = new Ghost({ color: "#8fd0ff", emissive: "#2d5f86" });
  private readonly target = new Ghost({ color: "#ffd166", emissive: "#7a5a12" });
  private readonly markers = new Markers();
  private cut: Cut = { kind: "none", part: 0.5, flipped: false };
  private box = new THREE.Box3();
  private stale = true;
  private drawings = 0;
  /** When the first picture with a frame was drawn, since the page was asked for [ms]; -1 before. */
  firstPicture = -1;
  private shown: FrameArrays | undefined;

  constructor(
    private readonly canvas: HTMLCanvasElement,
    private readonly around: Surroundings,
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
    this.rig = new Rig(canvas, () => this.refresh(), around.calm);
    this.scene.fog = this.haze;
    addLights(this.scene, this.rig.camera);
    this.scene.add(this.ghost.object, this.target.object, this.markers.object);
    new ResizeObserver(() => this.resize()).observe(canvas);
    this.renderer.setAnimationLoop((now) => this.beat(now));
  }

  /** Pictures drawn so far. */
  get count(): number {
    return this.drawings;
  }

  /** Whether the scene is shown as a diagram, with every vertex and edge. */
  show(bodies: Body[]): boolean {
    for (const view of this.views) {
      this.scene.remove(view.group);
      view.dispose();
    }
    this.shown = undefined;
    this.ghost.clear();
    this.target.clear();
    const diagram = verticesOf(bodies) <= mostOfADiagram;
    this.views = bodies.map((body) => new BodyView(body, diagram));
    for (const view of this.views) this.scene.add(view.group);
    this.showOverlays(this.overlays);
    const sample = sampleOf(bodies);
    this.box = new THREE.Box3().setFromPoints(sample);
    this.setCut(this.cut);
    this.resize();
    this.rig.frame(sample);
    this.refresh();
    return diagram;
  }

  /** The bodies as they stand, and the box they rest in. */
  get bodies(): readonly BodyView[] {
    return this.views;
  }

  get bounds(): THREE.Box3 {
    return this.box;
  }

  /** Whether a cut has taken this place away. */
  cutAway(place: THREE.Vector3): boolean {
    return this.renderer.clippingPlanes.some((plane) => plane.distanceToPoint(place) < 0);
  }

  /** Draws at the next beat. */
  refresh(): void {
    this.stale = true;
  }

  setLayerOpacity(layer: string, opacity: number): void {
    for (const view of this.views) if (view.body.layer === layer) view.setOpacity(opacity);
    this.refresh();
  }

  showOverlays(shown: ReadonlySet<OverlayKind>): void {
    this.overlays = shown;
    for (const view of this.views) for (const kind of overlayKinds) view.setOverlay(kind, shown.has(kind));
    this.refresh();
  }

  /** Takes away what lies on one side of a plane; where that lies along its axis [m]. */
  setCut(cut: Cut): number {
    this.cut = cut;
    const plane = this.plane();
    this.renderer.clippingPlanes = plane === undefined ? [] : [plane];
    this.refresh();
    return placeOf(cut, this.box);
  }

  /** Shows bodies as they were in `arrays`, at rest, or not at all, as a ghost. */
  setGhost(of: FrameArrays | "rest" | undefined, bodies: Body[]): void {
    if (of === undefined) this.ghost.clear();
    else this.ghost.show(bodies, of === "rest" ? undefined : of);
    this.refresh();
  }

  /** Shows what bodies are compared with, or nothing. */
  setTarget(surface: Surface | undefined): void {
    if (surface === undefined) this.target.clear();
    else this.target.showSurface(surface);
    this.refresh();
  }

  mark(markers: Marker[]): void {
    this.markers.show(markers);
    this.refresh();
  }

  /** Paints bodies by name, sRGB, three bytes a vertex, and no other. */
  paint(painted: ReadonlyMap<string, Uint8Array>): void {
    for (const view of this.views) view.paint(painted.get(view.body.name));
    this.refresh();
  }

  /** Dragging with the shift key pulls at the visible ones among the bodies of these names from now on. */
  letPull(
    names: () => ReadonlySet<string>,
    pull: Pull,
    told: (newtons: number | undefined, x: number, y: number) => void,
  ): void {
    const views = () => this.views.filter(({ body, group }) => group.visible && names().has(body.name));
    const [changed, plane] = [() => this.refresh(), () => this.plane()];
    new Pulling(this.canvas, this.rig.camera, this.scene, views, pull, changed, plane, told);
  }

  /** A click tells the vertex that is seen there from now on. */
  letClick(picked: (vertex: VertexRef | undefined) => void): void {
    letClick(
      this.canvas,
      this.rig.camera,
      () => this.views,
      () => this.plane(),
      picked,
    );
  }

  go(view: ViewName): void {
    this.rig.go(view);
  }

  /** The picture as it stands, without what lies over it. */
  photograph(): Promise<Blob | null> {
    this.renderer.render(this.scene, this.rig.camera);
    const { width, height } = this.canvas;
    const copy = Object.assign(document.createElement("canvas"), { width, height });
    const pen = copy.getContext("2d");
    if (pen === null) return Promise.resolve(null);
    pen.fillStyle = "#1f262d";
    pen.fillRect(0, 0, width, height);
    // Before the browser takes the picture off the canvas.
    pen.drawImage(this.canvas, 0, 0);
    return new Promise((done) => copy.toBlob(done, "image/png"));
  }

  /** Takes the canvas as it is now, and what panels leave of it. */
  resize(): void {
    const { clientWidth, clientHeight } = this.canvas;
    if (clientWidth === 0 || clientHeight === 0) return;
    this.renderer.setSize(clientWidth, clientHeight, false);
    this.rig.resize(this.around.covered());
    this.refresh();
  }

  private plane(): THREE.Plane | undefined {
    return planeOf(this.cut, this.box);
  }

  private beat(now: number): void {
    this.rig.update(now);
    if (this.around.advance()) this.stale = true;
    if (this.sharpness.beat(now, this.stale)) {
      this.renderer.setPixelRatio(this.sharpness.ratio);
      this.stale = true;
    }
    if (!this.stale) return;
    this.stale = false;
    const frame = this.around.source();
    if (frame !== undefined && frame !== this.shown) {
      for (const view of this.views) view.update(frame);
      this.around.update?.(frame);
      this.stale = false;
    }
    this.shown = frame;
    const { distance, extent } = this.rig.depth;
    [this.haze.near, this.haze.far] = [distance - 0.1 * extent, distance + 0.75 * extent];
    const compass = this.rig.compass();
    this.markers.scale(markerSize / compass.pixelsPerMetre);
    this.renderer.render(this.scene, this.rig.camera);
    this.drawings++;
    if (frame !== undefined && this.firstPicture < 0) this.firstPicture = performance.now();
    this.around.drawn(compass);
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
