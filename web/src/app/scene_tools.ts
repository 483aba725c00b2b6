import { ColorScale, niceTop } from "../appearance/color_scale";
import { Coloring } from "../appearance/coloring";
import { forceKindOf, tissueKindOf } from "../appearance/fields";
import { type GhostKind, GhostSelector } from "../appearance/ghosts";
import type { LayerStyles } from "../appearance/layer_styles";
import { LiveDistance } from "../appearance/live_distance";
import { TrackedVertices } from "../appearance/tracked_vertices";
import { make } from "../dom/elements";
import type { Frame } from "../gen/phrenic/v1/frames_pb";
import type { Body, FrameArrays } from "../geometry/bodies";
import type { CameraPose } from "../geometry/camera_pose";
import type { VertexRef } from "../geometry/vertices";
import type { LungTools } from "../lungs/lung_tools";
import { paintedSections } from "../appearance/painted_sections";
import type { TrackedSeries } from "../panels/readings/graphs";
import { appearancePanel } from "../panels/view/appearance_panel";
import { coloringCard } from "../panels/view/coloring_card";
import { OrientationCube } from "../panels/view/orientation_cube";
import { PickCard } from "../panels/view/pick_card";
import { rememberedQuality } from "../panels/view/quality_row";
import { isFilled, templateLegend } from "../panels/view/template_legend";
import { TissueCard } from "../panels/view/tissue_card";
import type { Comparisons } from "../session/comparisons";
import type { ForceQueries, ForceRequest } from "../session/force_queries";
import { Signal } from "../state/signal";
import type { Annotations } from "../viewer/annotations";
import type { ViewOrientation } from "../viewer/camera_rig";
import type { Cut } from "../viewer/clipping";
import { viewNames } from "../viewer/named_views";
import { paintTexts } from "../viewer/overlay_painter";
import type { OverlayKind } from "../viewer/overlays";
import { templateColor } from "../viewer/vertex_colors";
import type { Viewer } from "../viewer/viewer";
import { type Viewpoint, viewpoints } from "../viewer/viewpoints";
import { Measuring } from "./measuring";
import { namedAnnotations } from "./named_scene";
import { SceneStructures } from "./scene_structures";

/** The viewer's local tools: colours, ghost, labels, orientation cube, clipping, and picked and tracked vertices. */
export class SceneTools {
  readonly trackedVertices = new TrackedVertices(() => this.bodies);
  readonly panel: HTMLElement;
  /** Cards over the stage. */
  readonly cards: HTMLElement[];
  readonly cube: OrientationCube;
  readonly annotations: Annotations;
  readonly nameLabels: HTMLElement;
  readonly forceLabel = make("output", { id: "force", hidden: true });
  readonly coloring: Coloring;
  /** Settings that a second view shares. */
  readonly overlays = new Signal<ReadonlySet<OverlayKind>>(new Set());
  readonly labels = new Signal(false);
  readonly cut = new Signal<Cut>({ kind: "none", fraction: 0.5, flipped: false });
  readonly ghost = new Signal<GhostKind>("none");
  readonly quality = rememberedQuality();
  readonly structures: SceneStructures;
  readonly measuring: Measuring;
  /** The named views of the scene. */
  readonly viewpoints = new Signal<Viewpoint[]>([]);
  /** The cut of the named view that is shown. */
  private visitedCut: Cut | undefined;
  private readonly pickCard: PickCard;
  private readonly legend = templateLegend(templateColor);
  private readonly ghosts: GhostSelector;
  private bodies: Body[] = [];
  private tissue: Body[] = [];
  private liveDistance: LiveDistance | undefined;
  private time = 0;
  /** The replayed time [s]; undefined when live. */
  private replayTime: number | undefined;
  private forcesUnknown = false;
  /** True if the scene has lungs, whose tissue may be shown. */
  private readonly hasLungs = new Signal(false);

  constructor(
    private readonly viewer: Viewer,
    private readonly arrays: () => FrameArrays | undefined,
    layerStyles: LayerStyles,
    private readonly comparisons: Comparisons,
    private readonly forces: ForceQueries,
    private readonly lungs: LungTools,
  ) {
    this.coloring = new Coloring(forces, lungs.tissue);
    this.ghosts = new GhostSelector(viewer, arrays, this.ghost);
    this.pickCard = new PickCard(this.trackedVertices, forces.onVertex);
    this.cube = new OrientationCube((view) => this.visit(view));
    this.structures = new SceneStructures(viewer, layerStyles, (each) =>
      this.measuring.measurements.measureSurface(each),
    );
    const { annotations, nameLabels } = namedAnnotations(viewer, { ...this, layerStyles });
    [this.annotations, this.nameLabels] = [annotations, nameLabels];
    const pickAt = viewer.enablePicking(
      (ref) => this.pick(ref),
      (place) => lungs.follow(place),
    );
    this.measuring = new Measuring(viewer.canvas, this.annotations, () => this.bodies, this.structures, pickAt);
    for (const changes of [this.measuring.measurements.all, this.measuring.measurements.picked])
      changes.subscribe(() => this.updateMarkers());
    const tissueCard = new TissueCard(lungs.points);
    this.cards = [
      this.legend,
      coloringCard(this.coloring),
      tissueCard.element,
      this.structures.card,
      this.pickCard.element,
    ];
    const { labels, ghost, quality } = this;
    this.panel = appearancePanel({
      layerStyles,
      labels,
      ghost,
      quality,
      forceKinds: forces.kinds,
      hasLungs: this.hasLungs,
      overlays: this.overlays,
      coloring: this.coloring,
      cut: this.cut,
      cutAt: (cut) => viewer.cutCoordinate(cut),
    });
    this.cut.subscribe((cut) => {
      viewer.setCut(cut);
      this.updateSections();
    });
    this.overlays.subscribe((shown) => viewer.showOverlays(shown));
    quality.subscribe((chosen) => viewer.setQuality(chosen));
    this.coloring.field.subscribe(() => {
      this.updateFields();
      this.replayForces();
      tissueCard.element.hidden = tissueKindOf(this.coloring.field.value) === undefined;
    });
    lungs.tissue.queries.readings.subscribe(() => {
      this.updateFields();
      this.coloring.fitToTissue();
      if (tissueKindOf(this.coloring.field.value) !== undefined) this.updateColors();
      this.updateMarkers();
    });
    lungs.tissue.queries.message.subscribe(() => this.updateMessage());
    lungs.points.all.subscribe(() => this.updateMarkers());
    this.coloring.scale.subscribe(() => this.updateColors());
    comparisons.result.subscribe((result) => {
      this.liveDistance = result === undefined ? undefined : new LiveDistance(result);
      this.updateComparedSurface();
      this.updateColors();
    });
    comparisons.surfaceVisible.subscribe(() => this.updateComparedSurface());
    forces.magnitudes.subscribe(() => this.updateColors());
    this.structures.isolated.subscribe((structure) => structure && this.trackedVertices.picked.set(undefined));
    this.trackedVertices.picked.subscribe(() => {
      this.replayForces();
      this.updateMarkers();
    });
    this.trackedVertices.tracked.subscribe(() => this.updateMarkers());
  }

  /** Starts another scene, which the viewer shows already. `diagram` is true for scenes of few vertices. */
  start(bodies: Body[], tissue: ReadonlySet<string>, diagram: boolean): void {
    this.bodies = bodies;
    this.tissue = bodies.filter(({ name }) => tissue.has(name));
    this.viewpoints.set(viewpoints(bodies, this.viewer.bounds));
    this.structures.start(bodies);
    this.legend.hidden = !isFilled(bodies);
    this.coloring.start(this.tissue);
    void this.forces.start(this.tissue[0]?.name);
    this.lungs.start(bodies);
    this.hasLungs.set(bodies.some(({ name }) => name.startsWith("lung-")));
    this.trackedVertices.clear();
    this.measuring.measurements.clear();
    if (this.ghost.value === "now") this.ghost.set("none");
    this.ghosts.start(this.tissue);
    // A diagram shows which of its edges are rigid.
    if (diagram && bodies.some(({ rigidLinks }) => rigidLinks.length > 0))
      this.overlays.set(new Set([...this.overlays.value, "links"]));
  }

  /** Shows the outline of the second view's tissue, if that is selected. */
  showBeside(arrays: FrameArrays | undefined): void {
    this.ghosts.showBeside(arrays);
  }

  /** Measures at a picked vertex, or shows it and its structure. */
  private pick(ref: VertexRef | undefined): void {
    if (this.measuring.take(ref)) return;
    this.trackedVertices.picked.set(ref);
    this.structures.choose(ref);
  }

  /** The series of vertices and measurements that this viewer plots. */
  readonly ownSeries = (): TrackedSeries[] => {
    const { spec, history } = this.trackedVertices;
    const { graphs } = this.lungs.points;
    return [...(spec === undefined ? [] : [{ spec, history }]), ...graphs, ...this.measuring.measurements.graphs];
  };

  /** Shows a view by its name; unknown names change nothing. Its cut replaces that of the view before. */
  visit(name: string): void {
    const viewpoint = this.viewpoints.value.find((each) => each.name === name);
    const view = viewpoint?.view ?? viewNames.find((each) => each === name);
    if (view === undefined) return;
    if (viewpoint?.cut !== undefined) this.cut.set((this.visitedCut = { ...viewpoint.cut }));
    else if (this.cut.value === this.visitedCut) this.cut.set({ ...this.cut.value, kind: "none" });
    this.viewer.goTo(view);
  }

  /** Returns the view on white as PNG. */
  pictureForPaper(): Promise<Blob | null> {
    return this.viewer.captureForPaper();
  }

  /** The camera's pose [m]. */
  get pose(): CameraPose {
    return this.viewer.rig.pose;
  }

  /** Moves the camera to a pose. */
  lookFrom(pose: CameraPose): void {
    this.viewer.rig.moveTo(pose);
  }

  /** Receives every frame, also those that are not displayed. */
  receive(frame: Frame): void {
    this.ghosts.receive(frame);
  }

  /** Updates colours, markers and, if `tracks`, tracks before a frame of this time [s] is drawn. */
  beforeDraw(time: number, arrays: FrameArrays, tracks = true): void {
    this.time = time;
    this.updateFields();
    if (tracks) this.trackedVertices.receive(time, arrays);
    if (tracks && this.replayTime === undefined) this.measuring.measurements.receive(time, arrays);
    if (this.coloring.field.value !== undefined) this.updateColors();
    this.updateMarkers();
  }

  /** Passes the displayed frame to the coloring. */
  private updateFields(): void {
    const arrays = this.arrays();
    if (arrays !== undefined) this.coloring.receive(this.time, arrays);
  }

  /** Updates what depends on the camera. */
  afterDraw(orientation: ViewOrientation): void {
    this.cube.show(orientation);
    const arrays = this.arrays();
    if (arrays !== undefined) this.measuring.draw(arrays);
    this.annotations.draw();
  }

  /** Draws measurements, axes and names over a picture of the canvas. */
  paint(pen: CanvasRenderingContext2D, ratio: number): void {
    this.annotations.paint(pen, ratio);
    paintTexts(this.nameLabels, pen, ratio);
  }

  /** Queries the forces and the tissue that are shown. `seen` identifies the state that the viewer received last. */
  query(seen: string): void {
    void this.forces.query(this.forceRequest(), seen);
    this.lungs.query(tissueKindOf(this.coloring.field.value) !== undefined, seen);
  }

  /** Shows the forces of an earlier time [s], or live ones if `time` is undefined. */
  replayAt(time: number | undefined): void {
    this.replayTime = time;
    this.replayForces();
  }

  private forceRequest(): ForceRequest {
    const kind = forceKindOf(this.coloring.field.value);
    const picked = this.trackedVertices.picked.value;
    const vertex = this.tissue.some(({ name }) => name === picked?.body) ? picked : undefined;
    return { vertex, kind, bodies: kind === undefined ? [] : this.coloring.bodyNames };
  }

  private replayForces(): void {
    this.forces.replayAt(this.replayTime, this.forceRequest());
    const unknown =
      this.replayTime !== undefined &&
      this.forceRequest().kind !== undefined &&
      this.forces.magnitudes.value.size === 0;
    this.forcesUnknown = unknown;
    this.updateMessage();
  }

  private updateMessage(): void {
    const tissue = tissueKindOf(this.coloring.field.value) === undefined ? "" : this.lungs.tissue.queries.message.value;
    const unknown = "Forces are unknown at this time: only displayed forces are recorded.";
    this.coloring.message.set(this.forcesUnknown ? unknown : tissue);
  }

  /** Updates the readings and the colours of a comparison; called a few times per second. */
  updateReadings(): void {
    const arrays = this.arrays();
    this.pickCard.show(arrays);
    this.measuring.panel.show(arrays);
    if (arrays !== undefined && this.liveDistance?.update(this.bodies, arrays, () => performance.now()))
      this.updateColors();
  }

  /** Shows the pulling force [N] beside the pointer; hides it if undefined. */
  showForce(newtons: number | undefined, x: number, y: number): void {
    this.forceLabel.hidden = newtons === undefined;
    if (newtons === undefined) return;
    this.forceLabel.textContent = `${newtons.toFixed(2)} N`;
    this.forceLabel.style.transform = `translate(${x + 14}px, ${y + 14}px)`;
  }

  /** Colours of a comparison take precedence over those of a field. */
  private updateColors(): void {
    const comparison = this.comparisons.result.value;
    this.updateSections();
    if (comparison === undefined) return this.viewer.setVertexColors(this.coloring.colors());
    const { body, distances } = comparison;
    const scale = new ColorScale(niceTop(distances));
    this.viewer.setVertexColors(new Map([[body, scale.colors(this.liveDistance?.values ?? distances)]]));
  }

  /** Paints the lungs in the cut, if they are coloured by their tissue. */
  private updateSections(): void {
    this.viewer.showInCut(paintedSections(this.lungs.tissue, this.coloring, this.viewer.cutPlane, this.arrays()));
  }

  private updateComparedSurface(): void {
    const { result, surfaceVisible } = this.comparisons;
    this.viewer.setComparedSurface(surfaceVisible.value ? result.value?.surface : undefined);
  }

  private updateMarkers(): void {
    const arrays = this.arrays();
    if (arrays === undefined) return;
    const own = [...this.trackedVertices.markers(arrays), ...this.measuring.markers(arrays)];
    this.viewer.setMarkers([...own, ...this.lungs.markers()]);
  }
}
