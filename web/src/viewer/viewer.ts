import * as THREE from "three";
import { type Body, type FrameArrays, shownAtFirst, verticesOf } from "../geometry/bodies";
import { computeNormals } from "../geometry/normals";
import { computeOcclusion } from "../geometry/occlusion";
import type { AxisPlane, SectionPicture } from "../geometry/section";
import type { Simplifier } from "../geometry/simplified";
import type { Surface } from "../geometry/surface";
import { type Marker, type VertexRef } from "../geometry/vertices";
import { resolutionFor } from "./adaptive_resolution";
import { BodyView } from "./body_view";
import { CameraRig, type Insets, type ViewOrientation } from "./camera_rig";
import { enablePicking } from "./click_picking";
import { axisPlaneOf, clippingPlane, type Cut, CutPictures, CutWalls, planeCoordinate } from "./clipping";
import { TranslucentSurfaces } from "./ghost";
import { StudioLights } from "./lights";
import { Markers } from "./markers";
import type { ViewName } from "./named_views";
import { type OverlayKind, overlayKinds } from "./overlays";
import { type Pull, Pulling } from "./pulling";
import { pointerOf } from "./picking";
import { onPointerRest } from "./pointer_rest";
import { drawsInSoftware, Pace, type Quality, QualityChooser } from "./quality";
import { surfaceVertex } from "./surface_picking";

/** Scenes with at most this many vertices are drawn as diagrams. */
const maxDiagramVertices = 2000;
/** Background of pictures and films. */
export const pictureBackground = "#1f262d";
/** Radius of a marker [CSS pixels]. */
const markerSize = 5;

/** What the viewer needs from its page. */
export interface ViewerHost {
  /** Advances to the frame that is due; returns true if the display changes. */
  advance(): boolean;
  /** Returns the frame to display. */
  frame(): FrameArrays | undefined;
  /** Called before a frame is drawn for the first time. */
  beforeDraw?(frame: FrameArrays): void;
  /** Called after each drawing. */
  afterDraw(orientation: ViewOrientation): void;
  /** Returns the parts of the canvas that panels cover. */
  insets(): Insets;
  /** True if the user prefers reduced motion. */
  reducedMotion(): boolean;
  /** Loads what reduces triangles for plain quality. */
  simplifier(): Promise<Simplifier>;
}

/**
 * Draws the scene with three.js. Draws only after changes and in animation frames, so that a hidden tab draws nothing
 * and several received frames cause one drawing.
 */
export class Viewer {
  readonly rig: CameraRig;
  private readonly scene = new THREE.Scene();
  /** Depth cue: distant parts fade slightly into the background. */
  private readonly fog = new THREE.Fog(pictureBackground);
  private readonly renderer: THREE.WebGLRenderer;
  private views: BodyView[] = [];
  private overlays: ReadonlySet<OverlayKind> = new Set();
  private readonly software = drawsInSoftware();
  private readonly resolution = resolutionFor(this.software);
  private readonly ghost = new TranslucentSurfaces({ color: "#8fd0ff", emissive: "#2d5f86" });
  private readonly comparedSurface = new TranslucentSurfaces({ color: "#ffd166", emissive: "#7a5a12" });
  private readonly markers = new Markers();
  private readonly cutPictures = new CutPictures();
  private readonly cutWalls = new CutWalls();
  private readonly lights: StudioLights;
  private readonly quality: QualityChooser;
  private readonly pace = new Pace(this.software);
  /** True if the bodies have no ambient occlusion yet. */
  private unshaded = false;
  /** True if a shown body does not have the triangles of plain quality yet. */
  private unsimplified = false;
  private diagram = false;
  private cut: Cut = { kind: "none", fraction: 0.5, flipped: false };
  private box = new THREE.Box3();
  private dirty = true;
  private drawn = 0;
  /** Time of the first drawing that shows a frame, since navigation start [ms]; -1 before. */
  firstDrawTime = -1;
  private shown: FrameArrays | undefined;
  /** True while a film is made: only its frames are drawn. */
  private filming = false;
  private isCovered = false;

  constructor(
    readonly canvas: HTMLCanvasElement,
    private readonly host: ViewerHost,
  ) {
    this.renderer = new THREE.WebGLRenderer({
      canvas,
      antialias: !this.software,
      alpha: true,
      powerPreference: "high-performance",
    });
    this.renderer.toneMapping = THREE.ACESFilmicToneMapping;
    this.renderer.toneMappingExposure = 0.88;
    this.renderer.setPixelRatio(this.resolution.ratio);
    this.rig = new CameraRig(canvas, () => this.refresh(), host.reducedMotion);
    this.scene.fog = this.fog;
    this.quality = new QualityChooser(this.software);
    this.lights = new StudioLights(this.scene, this.rig.camera, this.renderer);
    this.lights.setQuality(this.quality.quality);
    const { ghost, comparedSurface, markers, cutPictures, cutWalls } = this;
    this.scene.add(...[ghost, comparedSurface, markers, cutPictures, cutWalls].map(({ object }) => object));
    new ResizeObserver(() => this.resize()).observe(canvas);
    this.renderer.setAnimationLoop((now) => this.onAnimationFrame(now));
  }

  /** Number of drawings so far. */
  get drawCount(): number {
    return this.drawn;
  }

  /** Shows another scene. Returns true if it is drawn as a diagram, with every vertex and edge. */
  show(bodies: Body[]): boolean {
    for (const view of this.views) {
      this.scene.remove(view.group);
      view.dispose();
    }
    this.shown = undefined;
    this.ghost.clear();
    this.comparedSurface.clear();
    const diagram = (this.diagram = verticesOf(bodies) <= maxDiagramVertices);
    this.views = bodies.map((body) => new BodyView(body, diagram));
    for (const view of this.views) {
      view.setDetailed(this.quality.quality !== "plain");
      this.scene.add(view.group);
    }
    this.unshaded = this.unsimplified = !diagram;
    this.showOverlays(this.overlays);
    const sample = sampleVertices(shownAtFirst(bodies));
    this.box = new THREE.Box3().setFromPoints(sample);
    this.setCut(this.cut);
    this.resize();
    this.rig.frame(
      sample,
      bodies.some(({ name }) => name.startsWith("rib-")),
    );
    this.refresh();
    return diagram;
  }

  /** The quality of the picture. */
  get pictureQuality(): Quality {
    return this.quality.quality;
  }

  /** Sets the quality of the picture; undefined to choose it by the measured time of a drawing. */
  setQuality(fixed: Quality | undefined): void {
    this.quality.fixed = fixed;
    this.applyQuality();
  }

  private applyQuality(): void {
    const { quality } = this.quality;
    this.lights.setQuality(quality);
    for (const view of this.views) view.setDetailed(quality !== "plain");
    this.refresh();
  }

  /** Computes ambient occlusion at rest, after the first drawing, which does not wait for it. */
  private shade(): void {
    this.unshaded = false;
    const solid = this.views.filter(({ body }) => body.triangles.length > 0 && body.opacity > 0);
    const surfaces = solid.map(({ body: { rest, triangles, opacity } }) => {
      const normals = new Float32Array(rest.length);
      computeNormals(rest, triangles, normals);
      return { rest, triangles, normals, occludes: opacity === 1 };
    });
    computeOcclusion(surfaces).forEach((covered, i) => solid[i].setOcclusion(covered));
    this.refresh();
  }

  /** Computes the triangles of plain quality, after the first drawing, which does not wait for it. */
  private async simplify(): Promise<void> {
    this.unsimplified = false;
    const simplifier = await this.host.simplifier();
    const shown = this.views.filter(({ group }) => group.visible);
    await Promise.all(shown.map((view) => view.simplify(simplifier)));
    this.refresh();
  }

  /** The views of the bodies. */
  get bodies(): readonly BodyView[] {
    return this.views;
  }

  /** Bounding box of the scene at rest [m]. */
  get bounds(): THREE.Box3 {
    return this.box;
  }

  /** Width and height of the canvas [CSS pixels]. */
  get size(): [width: number, height: number] {
    return [this.canvas.clientWidth, this.canvas.clientHeight];
  }

  /** The part of the canvas that panels do not cover [CSS pixels]. */
  get freePart(): { left: number; right: number; top: number; bottom: number } {
    const [width, height] = this.size;
    const { left, top, bottom } = this.host.insets();
    return { left, right: width, top, bottom: height - bottom };
  }

  /** True if the current cut clips this position. */
  isClipped(place: THREE.Vector3): boolean {
    return this.renderer.clippingPlanes.some((plane) => plane.distanceToPoint(place) < 0);
  }

  /** Sets whether another picture covers the view: frames advance and the host is called, but nothing is drawn. */
  setCovered(covered: boolean): void {
    this.isCovered = covered;
    this.shown = undefined;
    this.refresh();
  }

  /** Draws in the next animation frame. */
  refresh(): void {
    this.dirty = true;
  }

  /** Sets the opacity of all bodies of a layer, 0 to 1. */
  setLayerOpacity(layer: string, opacity: number): void {
    for (const view of this.views) if (view.body.layer === layer) view.setOpacity(opacity);
    this.unsimplified ||= opacity > 0 && !this.diagram;
    this.shown = undefined; // hidden bodies did not follow the frames
    this.refresh();
  }

  /** Shows these overlays and hides all others. */
  showOverlays(shown: ReadonlySet<OverlayKind>): void {
    this.overlays = shown;
    for (const view of this.views) for (const kind of overlayKinds) view.setOverlay(kind, shown.has(kind));
    this.refresh();
  }

  /** Clips one side of a plane. */
  setCut(cut: Cut): void {
    this.cut = cut;
    const plane = this.currentPlane();
    this.renderer.clippingPlanes = plane === undefined ? [] : [plane];
    for (const view of this.views) view.setCut(plane !== undefined);
    this.refresh();
  }

  /** Returns the coordinate of a cut along its axis [m]. */
  cutCoordinate(cut: Cut): number {
    return planeCoordinate(cut, this.box);
  }

  /** The plane of the current cut; undefined without one. */
  get cutPlane(): AxisPlane | undefined {
    return axisPlaneOf(this.cut, this.box);
  }

  /** Shows pictures in the plane of the cut, in place of all before. */
  showInCut(pictures: SectionPicture[]): void {
    this.cutPictures.show(pictures, this.currentPlane());
    this.refresh();
  }

  /** Shows bodies as a ghost or its outline, in the state of `arrays` or at rest; undefined removes it. */
  setGhost(of: FrameArrays | "rest" | undefined, bodies: Body[], outline = false): void {
    if (of === undefined) this.ghost.clear();
    else this.ghost.show(bodies, of === "rest" ? undefined : of, outline);
    this.refresh();
  }

  /** Shows the surface that a body is compared with; undefined removes it. */
  setComparedSurface(surface: Surface | undefined): void {
    if (surface === undefined) this.comparedSurface.clear();
    else this.comparedSurface.showSurface(surface);
    this.refresh();
  }

  /** Replaces all markers. */
  setMarkers(markers: Marker[]): void {
    this.markers.show(markers);
    this.refresh();
  }

  /** Sets the vertex colours of bodies by name, three sRGB bytes per vertex; other bodies get their own colours. */
  setVertexColors(painted: ReadonlyMap<string, Uint8Array>): void {
    for (const view of this.views) view.setColors(painted.get(view.body.name));
    this.refresh();
  }

  /** Enables pulling of visible bodies with these names by dragging with the shift key. */
  enablePulling(
    names: () => ReadonlySet<string>,
    pull: Pull,
    told: (newtons: number | undefined, x: number, y: number) => void,
  ): void {
    const views = () => this.views.filter(({ body, group }) => group.visible && names().has(body.name));
    const [changed, plane] = [() => this.refresh(), () => this.currentPlane()];
    new Pulling(this.canvas, this.rig.camera, this.scene, views, pull, changed, plane, told);
  }

  /**
   * Enables picking of vertices by clicks, and of places in the pictures of a cut [m]. Returns a function that picks at
   * a place on the canvas [CSS pixels].
   */
  enablePicking(
    picked: (vertex: VertexRef | undefined) => void,
    inside: (place: [number, number, number]) => void = () => picked(undefined),
  ): (x: number, y: number) => void {
    return enablePicking(
      this.canvas,
      this.rig.camera,
      () => this.views,
      () => this.currentPlane(),
      picked,
      this.cutPictures,
      inside,
    );
  }

  /**
   * Calls `rested` with the vertex under the resting pointer and its place [CSS pixels]; undefined if it rests on no
   * body.
   */
  enableHover(rested: (vertex: VertexRef | undefined, x: number, y: number) => void): void {
    const find = (event: PointerEvent) => {
      const visible = this.views.filter(({ group, isFaded }) => group.visible && !isFaded);
      const pointer = pointerOf(event, this.canvas);
      const { extent } = this.rig.depth;
      const vertex = surfaceVertex(pointer, this.rig.camera, visible, extent, this.currentPlane());
      rested(vertex, event.offsetX, event.offsetY);
    };
    onPointerRest(this.canvas, find, () => rested(undefined, 0, 0));
  }

  /** Fades all bodies but one and flies to its vertices; undefined shows all, from where they were seen before. */
  isolate(part: { body: string; vertices: number[] | undefined } | undefined): void {
    for (const view of this.views) {
      const own = view.body.name === part?.body;
      view.setFaded(part !== undefined && !own);
      view.setRegion(own ? part.vertices : undefined);
    }
    const view = this.views.find(({ body }) => body.name === part?.body);
    if (view === undefined || part === undefined) this.rig.flyBack();
    else this.rig.lookAt(placesOf(view.worldPositions(), part.vertices));
    this.refresh();
  }

  /** Moves the camera to a named view. */
  goTo(view: ViewName): void {
    this.rig.goTo(view);
  }

  /** Returns the current view as PNG. `annotate` draws over it, in pixels of which `ratio` make a CSS pixel. */
  capture(annotate: (pen: CanvasRenderingContext2D, ratio: number) => void): Promise<Blob | null> {
    const { clientWidth: width, clientHeight: height } = this.canvas;
    return this.picture(pictureBackground, { x: 0, y: 0, width, height }, annotate);
  }

  /** Returns the part of the view that panels do not cover on white, as PNG, for paper. */
  captureForPaper(): Promise<Blob | null> {
    return this.picture("#fff", this.freeArea);
  }

  private picture(
    background: string,
    area: Viewer["freeArea"],
    annotate?: (pen: CanvasRenderingContext2D, ratio: number) => void,
  ): Promise<Blob | null> {
    this.fog.color.set(background);
    this.renderer.render(this.scene, this.rig.camera);
    this.fog.color.set(pictureBackground);
    const ratio = this.canvas.width / Math.max(1, this.canvas.clientWidth);
    const [x, y, width, height] = [area.x, area.y, area.width, area.height].map((each) => Math.round(each * ratio));
    const copy = Object.assign(document.createElement("canvas"), { width, height });
    const pen = copy.getContext("2d");
    if (pen === null) return Promise.resolve(null);
    pen.fillStyle = background;
    pen.fillRect(0, 0, width, height);
    // The drawing buffer is valid only until the browser composes the page.
    pen.drawImage(this.canvas, -x, -y);
    annotate?.(pen, ratio);
    return new Promise((done) => copy.toBlob(done, "image/png"));
  }

  /** The part of the canvas that panels do not cover [CSS pixels]. */
  get freeArea(): { x: number; y: number; width: number; height: number } {
    const { left, top, bottom } = this.host.insets();
    const { clientWidth, clientHeight } = this.canvas;
    const [width, height] = [Math.max(1, clientWidth - left), Math.max(1, clientHeight - top - bottom)];
    return { x: left, y: top, width, height };
  }

  /** Begins a film with `ratio` device pixels per CSS pixel: until `endFilm`, only `drawForFilm` draws. */
  beginFilm(ratio: number): void {
    this.filming = true;
    this.renderer.setPixelRatio(ratio);
  }

  /** Draws the host's frame at once. The canvas that it returns has the picture only until the caller waits. */
  drawForFilm(): HTMLCanvasElement {
    this.draw();
    return this.canvas;
  }

  /** Ends a film and draws what is due again. */
  endFilm(): void {
    this.filming = false;
    this.renderer.setPixelRatio(this.resolution.ratio);
    this.shown = undefined;
    this.refresh();
  }

  /** Adapts to the current size of the canvas and of the covered parts. */
  resize(): void {
    const { clientWidth, clientHeight } = this.canvas;
    if (clientWidth === 0 || clientHeight === 0) return;
    this.renderer.setSize(clientWidth, clientHeight, false);
    this.rig.resize(this.host.insets());
    this.refresh();
  }

  private currentPlane(): THREE.Plane | undefined {
    return clippingPlane(this.cut, this.box);
  }

  private onAnimationFrame(now: number): void {
    if (this.filming) return;
    this.rig.update(now);
    if (this.host.advance()) this.dirty = true;
    let draws = this.dirty && this.pace.starts(now);
    if (this.resolution.recordFrame(now, draws)) {
      this.renderer.setPixelRatio(this.resolution.ratio);
      draws = true; // a canvas of another size is empty
    }
    if (this.quality.recordFrame(now, draws)) this.applyQuality();
    if (draws) this.draw();
  }

  private draw(): void {
    this.dirty = false;
    const hidden = this.isCovered && !this.filming;
    const frame = this.host.frame();
    if (frame !== undefined && frame !== this.shown) {
      for (const view of this.views) if (view.group.visible && !hidden) view.update(frame);
      this.host.beforeDraw?.(frame);
      this.dirty = false;
    }
    this.shown = frame;
    const { distance, extent } = this.rig.depth;
    [this.fog.near, this.fog.far] = [distance - 0.1 * extent, distance + 0.75 * extent];
    const orientation = this.rig.orientation();
    this.markers.scale(markerSize / orientation.pixelsPerMetre);
    this.lights.follow(this.rig.sceneCenter, extent);
    this.cutWalls.show(this.views, this.cutPlane, this.currentPlane()?.normal);
    if (!hidden) this.renderer.render(this.scene, this.rig.camera);
    this.drawn++;
    if (frame !== undefined && this.firstDrawTime < 0) this.firstDrawTime = performance.now();
    if (frame !== undefined && this.unshaded) this.shade();
    if (frame !== undefined && this.unsimplified && this.pictureQuality === "plain") void this.simplify();
    this.host.afterDraw(orientation);
  }
}

/** Returns the positions of some vertices, at most about a thousand; of all if `vertices` is undefined. */
function placesOf(positions: ArrayLike<number>, vertices: number[] | undefined): THREE.Vector3[] {
  const all = vertices ?? Array.from({ length: positions.length / 3 }, (_, i) => i);
  const stride = Math.ceil(all.length / 1000);
  const some = all.filter((_, i) => i % stride === 0);
  return some.map((i) => new THREE.Vector3().fromArray(positions, 3 * i));
}

/** Returns some thousands of rest positions as a sample of the scene. */
function sampleVertices(bodies: Body[]): THREE.Vector3[] {
  const stride = Math.max(1, Math.floor(verticesOf(bodies) / 4000));
  return bodies.flatMap(({ rest }) => {
    const points: THREE.Vector3[] = [];
    for (let i = 0; i < rest.length; i += 3 * stride) points.push(new THREE.Vector3(rest[i], rest[i + 1], rest[i + 2]));
    return points;
  });
}
