import { needsExactPositions } from "../appearance/fields";
import { LayerStyles } from "../appearance/layer_styles";
import type { Api } from "../connection/api";
import type { Identity } from "../connection/identity";
import { type ConnectionListener, type ConnectionState, SessionConnection } from "../connection/session_connection";
import { download } from "../dom/download";
import { ownStorage } from "../dom/storage";
import { elementById } from "../dom/elements";
import type { DisplayedFrame, FrameBuffer } from "../frames/frame_buffer";
import type { Frame } from "../gen/phrenic/v1/frames_pb";
import type { CompileReport } from "../gen/phrenic/v1/report_pb";
import type { Preset } from "../gen/phrenic/v1/scene_pb";
import { SessionState } from "../gen/phrenic/v1/session_pb";
import type { Body } from "../geometry/bodies";
import { LungTools } from "../lungs/lung_tools";
import { ComparisonCard } from "../panels/comparison/comparison_card";
import { distancePanel } from "../panels/comparison/distance_panel";
import { presetComparison } from "../panels/comparison/preset_comparison";
import { exportPanel } from "../panels/jobs/export_panel";
import { uploadPanel } from "../panels/jobs/upload_panel";
import { parameterSections } from "../panels/parameters/parameter_sections";
import { GraphsPanel } from "../panels/readings/graphs";
import { Measures } from "../panels/readings/measures";
import { Probes } from "../panels/readings/probes";
import { banners } from "../panels/session/banners";
import { compileReportPanel } from "../panels/session/compile_report";
import { ConnectionBadge, ViewerCount } from "../panels/session/connection_badge";
import { controlBadge, ControlDialog, controlledGroup } from "../panels/session/control_dialog";
import { encodingPanel } from "../panels/session/encoding_panel";
import { languageMenu } from "../panels/session/language_menu";
import { sessionButton } from "../panels/session/session_button";
import type { SessionChooser } from "../panels/session/session_chooser";
import { layersPanel } from "../panels/view/layers_panel";
import { Margins } from "../panels/view/margins";
import { playbackPanel } from "../panels/view/playback";
import { Readout } from "../panels/view/readout";
import { Timeline } from "../panels/view/timeline";
import { viewBar } from "../panels/view/view_bar";
import { CameraSharing } from "../session/camera_sharing";
import { ClassAnswers } from "../session/class_answers";
import { Comparisons } from "../session/comparisons";
import { Exports } from "../session/exports";
import { ForceQueries } from "../session/force_queries";
import type { LessonPlace } from "../session/lessons";
import type { PageView } from "../session/page_view";
import { Participation, refusalReason } from "../session/participation";
import { SessionController } from "../session/session_controller";
import { Uploads } from "../session/uploads";
import { Signal } from "../state/signal";
import type { Clock } from "../timing/clock";
import { Viewer } from "../viewer/viewer";
import { drawers } from "./drawers";
import { dropZone } from "./drop_zone";
import { appShortcuts } from "./app_shortcuts";
import { Fluoroscopy } from "./fluoroscopy";
import { stageInsets } from "./insets";
import type { PatientOpener } from "./patient_opener";
import { SceneTools } from "./scene_tools";
import { SecondView } from "./second_view";
import { sessionFrames } from "./session_frames";
import { SessionNumbers } from "./session_numbers";
import { shareDialog } from "./sharing";
import { skipLinks } from "./skip_links";
import { studiesSection } from "./studies_section";
import { StudentView } from "./student_view";
import { testHook } from "./test_hook";

/** Update intervals of texts and numbers, and of graphs [ms]. */
const statusInterval = 200;
const graphInterval = 100;

/** What the page shows, from its address. */
export interface PageTarget {
  sessionId: string;
  /** Id of a session that is shown in a second view beside the first. */
  secondSessionId: string | undefined;
  view: PageView;
  /** The lesson and step that are played. */
  lesson: LessonPlace | undefined;
  /** The address of the page when it was opened. */
  address: URL;
  /** Reloads the page with this query string. */
  open(query: string): void;
  importPatient: PatientOpener;
}

/** One session on one page: connects the connection, the viewer and the panels. */
export class App {
  private readonly frames = sessionFrames(() => this.controller);
  private readonly layerStyles = new LayerStyles();
  private readonly report = new Signal<CompileReport | undefined>(undefined);
  private readonly presets = new Signal<Preset[]>([]);
  private readonly connectionState = new Signal<ConnectionState>({ kind: "connecting" });
  private readonly controller: SessionController;
  private readonly participation: Participation;
  private readonly cameraSharing: CameraSharing;
  private readonly connection: SessionConnection;
  private readonly numbers: SessionNumbers;
  private readonly viewer: Viewer;
  private readonly tools: SceneTools;
  private readonly graphs: GraphsPanel;
  private readonly secondView: SecondView | undefined;
  /** The frame of a film that is drawn; undefined while no film is made. */
  private filmed: DisplayedFrame | undefined;
  private readonly student: StudentView;
  private readonly fluoroscopy: Fluoroscopy;
  private readonly margins = new Margins();
  private readonly connectionBadge: ConnectionBadge;
  private readonly viewers = new ViewerCount();
  private readonly readout = new Readout();
  private readonly timeline = new Timeline(this.frames, (time) => this.replayAt(time));
  private readonly probes = new Probes();
  private readonly measures = new Measures();
  private readonly comparisons: Comparisons;
  private readonly exports: Exports;
  private readonly uploads: Uploads;
  private readonly comparisonCard: ComparisonCard;
  private readonly bodies = new Signal<Body[]>([]);
  /** Last known top of the dock [CSS pixels]. */
  private dockTop = 0;
  /** Names of the bodies that show tissue. */
  private tissue: ReadonlySet<string> = new Set();

  constructor(
    private readonly api: Api,
    private readonly target: PageTarget,
    private readonly chooser: SessionChooser,
    private readonly identity: Identity,
    private readonly clock: Clock,
  ) {
    const { sessionId } = target;
    this.controller = new SessionController(api, sessionId, clock);
    this.participation = new Participation(api, this.controller, identity, clock);
    this.comparisons = new Comparisons(api, sessionId);
    this.exports = new Exports(api, sessionId);
    this.uploads = new Uploads(api);
    this.comparisonCard = new ComparisonCard(this.comparisons);
    this.connection = new SessionConnection(api, sessionId, this.connectionListener(), clock);
    this.connectionBadge = new ConnectionBadge(() => this.connection.retryNow());
    this.viewer = new Viewer(elementById("view") as HTMLCanvasElement, this.viewerHost());
    this.tools = new SceneTools(
      this.viewer,
      () => this.displayed?.arrays,
      this.layerStyles,
      this.comparisons,
      new ForceQueries(api, sessionId),
      new LungTools(api, sessionId),
    );
    this.cameraSharing = new CameraSharing(api, sessionId, this.participation, this.viewer.rig, clock);
    const listener = {
      record: (numbers: Frame, present: boolean) => this.record(numbers, present),
      gap: () => {
        this.graphs.gap();
        this.student.gap();
      },
      refused: (reason: string) => {
        this.graphs.refused(reason);
        this.student.refused(reason);
      },
      referencesChanged: () => this.graphs.refresh(this.frames.frame),
    };
    this.numbers = new SessionNumbers(api, this.controller, this.presets, listener, clock);
    this.graphs = new GraphsPanel(() => sessionId, this.tools.ownSeries, this.numbers.references.now);
    this.secondView = this.openSecondView();
    this.student = this.openStudentView();
    this.fluoroscopy = this.openFluoroscopy();
    window.phrenic = testHook(
      () => this.bodies.value,
      this.frames,
      this.viewer,
      () => this.fluoroscopy.picture,
    );
  }

  /** Builds the page and connects to the server. */
  start(): void {
    this.buildStage();
    this.buildPanel();
    this.buildHeader();
    this.layerStyles.all.subscribe((styles) => {
      for (const { layer, opacity, visible } of styles) this.viewer.setLayerOpacity(layer, visible ? opacity : 0);
      this.requestBodies();
    });
    this.tools.labels.subscribe(() => this.resize());
    this.comparisons.result.subscribe((result) => result && this.showLayerOf(result.body));
    // Playing ends the replay.
    let playing = true;
    this.controller.session.subscribe((session) => {
      const [before, now] = [playing, session?.state === SessionState.PLAYING];
      playing = now;
      if (now && !before && this.timeline.replaying) this.replayAt(undefined);
    });
    setInterval(() => this.updateStatus(), statusInterval);
    setInterval(() => document.hidden || this.drawGraphs(), graphInterval);
    window.addEventListener("pagehide", () => this.controller.flush());
    this.tools.coloring.field.subscribe((kind) => this.connection.setExact(needsExactPositions(kind)));
    this.numbers.start();
    void this.connection.run();
    void this.participation.run();
  }

  private get displayed(): DisplayedFrame | undefined {
    return this.filmed ?? this.frames.displayed;
  }

  private viewerHost() {
    const reduced = matchMedia("(prefers-reduced-motion: reduce)");
    return {
      advance: () => this.frames.advance(this.clock.now(), reduced.matches),
      frame: () => this.displayed?.arrays,
      beforeDraw: (arrays: NonNullable<FrameBuffer["arrays"]>) => {
        const live = this.filmed === undefined;
        const time = this.displayed?.time ?? 0;
        this.tools.beforeDraw(time, arrays, live);
        if (live && !this.timeline.replaying) this.graphs.mMode.receive(time, arrays);
      },
      afterDraw: (orientation: Parameters<Margins["show"]>[0]) => {
        if (this.displayed !== undefined) this.numbers.afterDraw();
        this.margins.show(orientation);
        this.fluoroscopy.draw();
        this.tools.afterDraw(orientation);
        this.secondView?.followCamera();
        this.cameraSharing.sendIfMoved();
      },
      insets: () => stageInsets(this.tools.labels.value),
      reducedMotion: () => reduced.matches,
      simplifier: () => import("../geometry/simplified"),
    };
  }

  private openSecondView(): SecondView | undefined {
    const { sessionId, secondSessionId, open } = this.target;
    if (secondSessionId === undefined || secondSessionId === sessionId) return undefined;
    const { viewer, frames, tools, layerStyles, controller, presets } = this;
    const mayChange = () => refusalReason(this.participation.roles.value) === "";
    const besideSamples = {
      sample: (numbers: Frame, present: boolean) => this.student.recordBeside(numbers, present),
      gap: () => this.student.gapBeside(),
      refused: (reason: string) => this.student.refused(reason, true),
    };
    const shared = { viewer, frames, tools, layerStyles, controller, presets };
    const primary = { ...shared, host: this.viewerHost(), mayChange, besideSamples };
    return new SecondView(this.api, secondSessionId, primary, this.clock, {
      swap: () => open(`?${new URLSearchParams({ session: secondSessionId, beside: sessionId })}`),
      close: () => open(`?${new URLSearchParams({ session: sessionId })}`),
    });
  }

  private openStudentView(): StudentView {
    const { controller, participation, presets, report, tools, layerStyles, secondView, identity } = this;
    const { open, view, lesson, sessionId } = this.target;
    const answers = new ClassAnswers(this.api, sessionId, identity);
    const catchUp = () => this.numbers.catchUp();
    const shown = {
      tools,
      layerStyles,
      secondView,
      catchUp,
      references: this.numbers.references.now,
      resized: () => this.resize(),
    };
    return new StudentView(
      { controller, participation, presets, report, lesson, open, answers, identity, ...shown },
      view,
    );
  }

  private openFluoroscopy(): Fluoroscopy {
    const { viewer, controller, participation, presets } = this;
    return new Fluoroscopy({
      viewer,
      controller,
      presets,
      bodies: () => this.bodies.value,
      frame: () => this.displayed?.arrays,
      refusal: () => refusalReason(participation.roles.value),
      changed: () => this.requestBodies(),
    });
  }

  /** Requests the positions of the bodies that are seen, by eyes or by X-rays. */
  private requestBodies(): void {
    this.connection.setBodies(this.fluoroscopy.isOpen ? [] : this.layerStyles.neededBodies(this.bodies.value));
  }

  private buildStage(): void {
    const { controller, viewer, tools } = this;
    viewer.enablePulling(
      () => this.tissue,
      (body, vertex, force) => {
        const refused = refusalReason(this.participation.roles.value);
        if (refused === "") controller.pull(body, vertex, force);
        else controller.notice.set(refused);
      },
      (newtons, x, y) => tools.showForce(newtons, x, y),
    );
    elementById("cards").append(...tools.cards, this.comparisonCard.element);
    new ResizeObserver(() => this.resize()).observe(elementById("cards"));
    const drop = dropZone(
      document.body,
      (file) => void this.comparisons.compare(file),
      (dropped) => void this.target.importPatient(dropped),
    );
    elementById("stage").append(drop, tools.forceLabel, tools.structures.label, ...tools.measuring.overlays);
    if (this.secondView !== undefined) {
      elementById("stage").classList.add("split");
      elementById("view").after(this.secondView.element);
      elementById("stage").append(this.secondView.headers.element);
      new ResizeObserver(() => this.resize()).observe(this.secondView.headers.element);
    }
    elementById("annotations-slot").append(tools.annotations.element, tools.nameLabels);
    elementById("cube-slot").append(tools.cube.element);
    elementById("playback-slot").append(controlledGroup(this.participation, playbackPanel(controller)));
    elementById("readout-slot").append(this.timeline.element, this.readout.element);
    elementById("margins").append(...this.margins.elements);
    const bar = viewBar(viewer, elementById("view"), tools.viewpoints, (name) => tools.visit(name));
    elementById("views").append(...bar, this.fluoroscopy.button, tools.structures.search);
    elementById("banners").append(...banners(controller, this.connectionState, () => void this.chooser.show()));
  }

  private buildPanel(): void {
    const { controller, layerStyles } = this;
    const sections = parameterSections(controller, this.report, this.presets);
    const solver = sections.pop()!;
    elementById("panel").append(
      presetComparison(controller, this.presets, this.target.open),
      controlledGroup(this.participation, ...sections),
      this.tools.panel,
      this.tools.measuring.panel.element,
      layersPanel(layerStyles),
      controlledGroup(this.participation, solver),
      encodingPanel((codec) => this.connection.setCodec(codec)),
      this.probes.element,
      this.measures.element,
      distancePanel(this.comparisons, this.bodies, this.uploads.extensions),
      studiesSection(this.api, this.clock, controller),
      exportPanel(this.exports, this.bodies),
      uploadPanel(this.uploads),
      compileReportPanel(this.report),
    );
    elementById("graphs").append(this.graphs.element);
  }

  private buildHeader(): void {
    const { api, controller, viewer, report, tools, student, fluoroscopy, timeline } = this;
    const { open, sessionId } = this.target;
    const photograph = () => void this.photograph();
    const share = shareDialog({
      ...{ api, sessionId, controller, report, viewer, tools, open, photograph },
      names: () => this.bodies.value.map(({ name }) => name),
      showFilmed: (frame) => (this.filmed = frame),
    });
    const { graphs, panel } = drawers(() => this.resize(), this.secondView !== undefined);
    const keys = appShortcuts({
      ...{ tools, student, fluoroscopy, timeline, toggleGraphs: graphs, togglePanel: panel, photograph },
      share: () => share.show(),
      undo: () => controller.undo(),
      redo: () => controller.redo(),
    });
    const control = new ControlDialog(this.participation, () => this.cameraSharing.follow());
    document.body.prepend(skipLinks());
    document.body.append(share.element, keys, control.element);
    elementById("share-open").onclick = () => share.show();
    elementById("help-open").onclick = () => keys.showModal();
    elementById("help-open").before(languageMenu(ownStorage, this.target.open));
    elementById("status-slot").append(
      controlBadge(this.participation, () => control.show()),
      this.viewers.element,
      this.connectionBadge.element,
    );
    elementById("session-slot").append(sessionButton(controller, () => void this.chooser.show()));
  }

  /** Saves a picture of the view. */
  private async photograph(): Promise<void> {
    const picture = await this.viewer.capture((pen, ratio) => this.tools.paint(pen, ratio));
    if (picture !== null) download(`${this.target.sessionId}.png`, picture);
  }

  /** Distributes what the connection receives. */
  private connectionListener(): ConnectionListener {
    return {
      state: (link) => this.connectionState.set(link),
      session: (session, fresh) => this.controller.receive(session, fresh),
      frame: (frame) => {
        this.frames.receive(frame, this.clock.now());
        this.graphs.receive(frame);
        this.student.receive(frame);
        this.fluoroscopy.receive(frame);
        this.tools.receive(frame);
      },
      camera: (camera) => this.cameraSharing.receive(camera),
      basis: (basis) => this.frames.addBasis(basis),
      acknowledged: (response, sent, answered) => this.frames.acknowledged(response, sent, answered),
      scene: (bodies, report) => this.showScene(bodies, report),
    };
  }

  /** Records the numbers of a sample for the graphs. */
  private record(numbers: Frame, present: boolean): void {
    this.graphs.record(numbers, present);
    this.student.record(numbers, present);
  }

  private showScene(bodies: Body[], report: CompileReport): void {
    this.comparisons.clear();
    this.bodies.set(bodies);
    this.frames.start(bodies);
    this.graphs.clear();
    this.graphs.mMode.start(bodies);
    this.report.set(report);
    this.tissue = new Set(report.bodies.filter(({ tissue }) => tissue).map(({ name }) => name));
    this.comparisons.choose({ body: this.mainBody(bodies) });
    const diagram = this.viewer.show(bodies);
    this.layerStyles.start(bodies, report);
    this.tools.start(bodies, this.tissue, diagram);
    this.tools.measuring.measureAsLinked(this.target.address, this.controller.notice);
    this.student.start();
    this.numbers.recordNewest();
    this.fluoroscopy.start(bodies);
    elementById("loading").hidden = true;
  }

  /** Shows the layer of a body, if it is hidden. */
  private showLayerOf(name: string): void {
    const layer = this.bodies.value.find((body) => body.name === name)?.layer ?? "";
    if (this.layerStyles.get(layer)?.visible === false) this.layerStyles.change(layer, { visible: true });
  }

  /** Returns the body of tissue with the most triangles. */
  private mainBody(bodies: Body[]): string {
    const moving = bodies.filter(({ name, triangles }) => this.tissue.has(name) && triangles.length > 0);
    return moving.sort((a, b) => b.triangles.length - a.triangles.length)[0]?.name ?? "";
  }

  private resize(): void {
    this.viewer.resize();
    this.secondView?.resize();
  }

  private replayAt(time: number | undefined): void {
    this.frames.replayAt(time);
    this.secondView?.replayAt(time);
    this.tools.replayAt(this.frames.replayedFrame?.time);
  }

  private drawGraphs(): void {
    this.graphs.draw();
    this.student.draw();
    if (this.timeline.replaying) return;
    const session = this.controller.session.value;
    this.tools.query(`${this.frames.frame?.tick} ${session?.revision}`);
    this.secondView?.query();
  }

  private updateStatus(): void {
    if (document.hidden) return;
    const now = this.clock.now();
    const session = this.controller.session.value;
    const rate = this.frames.rate(now);
    const frame = this.frames.replayedFrame ?? this.frames.liveFrame(now);
    const status = { connection: this.connectionState.value, session, frame, rate, now };
    this.connectionBadge.show(status);
    this.viewers.show(status);
    this.readout.show(status);
    this.probes.show(status.frame);
    this.timeline.show();
    // Texts that need another line change the height of the dock.
    if (elementById("dock").offsetTop !== this.dockTop) this.resize();
    this.dockTop = elementById("dock").offsetTop;
    this.secondView?.updateStatus(status.frame, now);
    this.measures.show(status.frame);
    this.comparisonCard.show(status.frame?.time);
    this.tools.updateReadings();
  }
}
