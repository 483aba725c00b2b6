import { forceKindOf, needsExactPositions, tissueKindOf } from "../appearance/fields";
import { GhostSelector } from "../appearance/ghosts";
import type { LayerStyles } from "../appearance/layer_styles";
import { VertexColorizer } from "../appearance/vertex_colorizer";
import type { Api } from "../connection/api";
import { SampleFeed, type SampleListener } from "../connection/sample_feed";
import { type ConnectionListener, SessionConnection } from "../connection/session_connection";
import { make } from "../dom/elements";
import { type FrameBuffer, maxWait } from "../frames/frame_buffer";
import type { Frame } from "../gen/phrenic/v1/frames_pb";
import { type Preset } from "../gen/phrenic/v1/scene_pb";
import { type Session, SessionState } from "../gen/phrenic/v1/session_pb";
import type { Body } from "../geometry/bodies";
import { LungTissue } from "../lungs/lung_tissue";
import { paintedSections } from "../appearance/painted_sections";
import { ViewHeaders } from "../panels/comparison/view_headers";
import { ForceQueries, type ForceRequest } from "../session/force_queries";
import { SessionController } from "../session/session_controller";
import type { Signal } from "../state/signal";
import type { Clock } from "../timing/clock";
import type { Annotations } from "../viewer/annotations";
import { Viewer, type ViewerHost } from "../viewer/viewer";
import { sessionFrames } from "./session_frames";
import { namedAnnotations } from "./named_scene";
import type { SceneTools } from "./scene_tools";
import { t } from "../language/translate";

/** Two playing sessions that differ by more than this [s] for this many checks are synchronised again. */
const maxTimeDifference = 0.2;
const checksBeforeResync = 10;

/** What the second view shares with the primary one. */
export interface PrimaryView {
  viewer: Viewer;
  frames: FrameBuffer;
  tools: SceneTools;
  layerStyles: LayerStyles;
  controller: SessionController;
  presets: Signal<Preset[]>;
  host: Pick<ViewerHost, "insets" | "reducedMotion" | "simplifier">;
  /** True if this viewer may play and pause the session. */
  mayChange(): boolean;
  /** Receives the samples of the second session. */
  besideSamples: SampleListener;
}

/**
 * A view of a second session that shares camera, layers, colours and their scale, clipping, ghost and labels with the
 * primary view. It plays and pauses in step with the primary session.
 */
export class SecondView {
  readonly element: HTMLElement;
  readonly headers: ViewHeaders;
  private readonly viewer: Viewer;
  private readonly controller: SessionController;
  private readonly connection: SessionConnection;
  private readonly frames = sessionFrames(() => this.controller);
  private readonly forces: ForceQueries;
  private readonly lungs: LungTissue;
  private readonly colorizer: VertexColorizer;
  private readonly ghosts: GhostSelector;
  private readonly annotations: Annotations;
  private bodies: Body[] = [];
  private leadsCamera = false;
  private checksOutOfStep = 0;

  constructor(
    private readonly api: Api,
    private readonly sessionId: string,
    private readonly primary: PrimaryView,
    private readonly clock: Clock,
    actions: { swap(): void; close(): void },
  ) {
    const canvas = make("canvas", { role: "img", ariaLabel: t("3D view of the session {0}", sessionId) });
    this.controller = new SessionController(api, sessionId, clock);
    primary.controller.companion = this.controller;
    primary.frames.synchroniseWith(this.frames);
    this.headers = new ViewHeaders([primary.controller, this.controller], primary.presets, actions);
    this.viewer = new Viewer(canvas, this.viewerHost());
    const { tools, layerStyles } = primary;
    const { annotations, nameLabels } = namedAnnotations(this.viewer, { ...tools, layerStyles });
    this.annotations = annotations;
    this.element = make("div", { id: "second-view" }, canvas, annotations.element, nameLabels);
    this.forces = new ForceQueries(api, sessionId);
    this.lungs = new LungTissue(api, sessionId);
    this.colorizer = new VertexColorizer(this.forces, this.lungs);
    this.ghosts = new GhostSelector(this.viewer, () => this.frames.displayed?.arrays, primary.tools.ghost);
    this.connection = new SessionConnection(api, sessionId, this.connectionListener(), clock);
    this.trackCameraLeader(canvas);
    this.followAppearance();
    const samples = new SampleFeed(api, sessionId, primary.besideSamples, clock);
    this.controller.session.subscribe(() => samples.wake());
    void this.connection.run();
    void samples.run();
  }

  /** The second session. */
  get session(): Signal<Session | undefined> {
    return this.controller.session;
  }

  /** Ends the comparison: deletes the second session if it is a temporary copy. */
  async end(): Promise<void> {
    if (this.session.value?.temporary !== true) return;
    // If this call fails, the server deletes the temporary copy once it has no viewers.
    await this.api.sessions.deleteSession({ sessionId: this.sessionId }).catch(() => undefined);
  }

  /** Copies the camera of the primary view. */
  followCamera(): void {
    if (!this.leadsCamera) this.viewer.rig.copyFrom(this.primary.viewer.rig);
  }

  /** Adapts to the current size of the canvas. */
  resize(): void {
    this.viewer.resize();
  }

  /** Updates the headers; `now` is in ms. */
  updateStatus(primaryFrame: Frame | undefined, now: number): void {
    this.headers.update([primaryFrame, this.frames.replayedFrame ?? this.frames.liveFrame(now)]);
    this.primary.tools.showBeside(this.frames.displayed?.arrays);
    const [here, there] = [this.primary.frames, this.frames].map(({ frame }) => frame?.time ?? 0);
    this.resynchronise(Math.abs(here - there));
  }

  /** Shows an earlier time [s] like the primary view, or live frames if undefined. */
  replayAt(time: number | undefined): void {
    this.frames.replayAt(time);
    this.forces.replayAt(time, this.forceRequest());
  }

  /** Queries the forces or the tissue that this view is coloured by. */
  query(): void {
    const seen = `${this.frames.frame?.tick} ${this.controller.session.value?.revision}`;
    void this.forces.query(this.forceRequest(), seen);
    if (tissueKindOf(this.primary.tools.coloring.field.value) !== undefined) void this.lungs.queries.query([], seen);
  }

  private forceRequest(): ForceRequest {
    const kind = forceKindOf(this.primary.tools.coloring.field.value);
    return { vertex: undefined, kind, bodies: kind === undefined ? [] : this.colorizer.bodyNames };
  }

  /** The view that the user turned last determines the camera. */
  private trackCameraLeader(canvas: HTMLCanvasElement): void {
    const lead = (event: Event) => (this.leadsCamera = event.target === canvas);
    for (const kind of ["pointerdown", "wheel", "keydown"])
      document.addEventListener(kind, lead, { capture: true, passive: true });
  }

  /** Applies the settings of the primary view whenever they change. */
  private followAppearance(): void {
    const { layerStyles, tools } = this.primary;
    const { coloring } = tools;
    layerStyles.all.subscribe(() => this.applyLayerStyles());
    tools.overlays.subscribe((shown) => this.viewer.showOverlays(shown));
    tools.quality.subscribe((chosen) => this.viewer.setQuality(chosen));
    tools.cut.subscribe((cut) => {
      this.viewer.setCut(cut);
      this.updateColors();
    });
    coloring.field.subscribe((kind) => {
      this.connection.setExact(needsExactPositions(kind));
      this.updateFields();
    });
    coloring.scale.subscribe(() => this.updateColors());
    this.forces.magnitudes.subscribe(() => this.updateColors());
    this.lungs.queries.readings.subscribe(() => {
      this.updateFields();
      this.updateColors();
    });
  }

  private viewerHost(): ViewerHost {
    const { host, viewer } = this.primary;
    return {
      ...host,
      advance: () => this.frames.advance(this.clock.now(), host.reducedMotion()),
      frame: () => this.frames.displayed?.arrays,
      beforeDraw: () => {
        this.updateFields();
        if (this.primary.tools.coloring.field.value !== undefined) this.updateColors();
      },
      afterDraw: () => {
        this.annotations.draw();
        if (this.leadsCamera) viewer.rig.copyFrom(this.viewer.rig);
      },
    };
  }

  private connectionListener(): ConnectionListener {
    return {
      state: () => undefined,
      session: (session, fresh) => this.controller.receive(session, fresh),
      scene: (bodies, report) => {
        this.show(bodies, new Set(report.bodies.filter(({ tissue }) => tissue).map(({ name }) => name)));
      },
      basis: (basis) => this.frames.addBasis(basis),
      acknowledged: (response, sent, answered) => this.frames.acknowledged(response, sent, answered),
      frame: (frame) => {
        this.frames.receive(frame, this.clock.now());
        this.ghosts.receive(frame);
      },
    };
  }

  private show(bodies: Body[], tissueNames: ReadonlySet<string>): void {
    const tissue = bodies.filter(({ name }) => tissueNames.has(name));
    this.bodies = bodies;
    this.frames.start(bodies);
    this.viewer.show(bodies);
    this.colorizer.start(tissue);
    this.lungs.start(bodies);
    this.ghosts.start(tissue);
    this.followCamera();
    this.applyLayerStyles();
  }

  private applyLayerStyles(): void {
    const styles = this.primary.layerStyles.all.value;
    for (const { layer, opacity, visible } of styles) this.viewer.setLayerOpacity(layer, visible ? opacity : 0);
    this.connection.setBodies(this.primary.layerStyles.neededBodies(this.bodies));
  }

  private updateFields(): void {
    const moment = this.frames.displayed;
    if (moment !== undefined) this.colorizer.receive(moment.time, moment.arrays);
  }

  private updateColors(): void {
    const { field, scale } = this.primary.tools.coloring;
    this.viewer.setVertexColors(this.colorizer.colors(field.value, scale.value));
    const { displayed } = this.frames;
    const { coloring } = this.primary.tools;
    this.viewer.showInCut(paintedSections(this.lungs, coloring, this.viewer.cutPlane, displayed?.arrays));
  }

  /** Synchronises the sessions again if others played them separately or the server restarted. */
  private resynchronise(timeDifference: number): void {
    const { controller, mayChange } = this.primary;
    const playing = [controller, this.controller].every(({ session }) => session.value?.state === SessionState.PLAYING);
    this.checksOutOfStep =
      playing && mayChange() && timeDifference > maxTimeDifference && timeDifference < maxWait
        ? this.checksOutOfStep + 1
        : 0;
    if (this.checksOutOfStep < checksBeforeResync) return;
    this.checksOutOfStep = 0;
    void controller.resynchronise();
  }
}
