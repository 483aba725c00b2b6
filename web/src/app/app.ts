import { needsExact } from "../appearance/fields";
import { Looks } from "../appearance/layer_styles";
import type { Api } from "../connection/api";
import type { Identity } from "../connection/identity";
import { Connection, type Link, type Sink } from "../connection/session_connection";
import { download } from "../dom/download";
import { place } from "../dom/elements";
import { Frames } from "../frames/frame_buffer";
import type { CompileReport } from "../gen/phrenic/v1/report_pb";
import type { Preset } from "../gen/phrenic/v1/scene_pb";
import { SessionState } from "../gen/phrenic/v1/session_pb";
import type { Body } from "../geometry/bodies";
import { ComparisonCard } from "../panels/comparison/comparison_card";
import { comparePanel } from "../panels/comparison/distance_panel";
import { compareWith } from "../panels/comparison/preset_comparison";
import { exportPanel } from "../panels/jobs/export_panel";
import { studiesPanel } from "../panels/jobs/studies_panel";
import { uploadPanel } from "../panels/jobs/upload_panel";
import { parameterSections } from "../panels/parameters/parameter_sections";
import { Graphs } from "../panels/readings/graphs";
import { Measures } from "../panels/readings/measures";
import { Probes } from "../panels/readings/probes";
import { banners } from "../panels/session/banners";
import { reportPanel } from "../panels/session/compile_report";
import { LinkPill, ViewerCount } from "../panels/session/connection_badge";
import { controlBadge, ControlDialog, controlled } from "../panels/session/control_dialog";
import { streamPanel } from "../panels/session/encoding_panel";
import { sessionButton } from "../panels/session/session_button";
import type { Chooser } from "../panels/session/session_chooser";
import { ShareDialog } from "../panels/session/share_dialog";
import { layersPanel } from "../panels/view/layers_panel";
import { Margins } from "../panels/view/margins";
import { playbackPanel } from "../panels/view/playback";
import { Readout } from "../panels/view/readout";
import { Timeline } from "../panels/view/timeline";
import { viewBar } from "../panels/view/view_bar";
import { CameraLead } from "../session/camera_sharing";
import { Comparisons } from "../session/comparisons";
import { Exports } from "../session/exports";
import { Forces } from "../session/force_queries";
import { refusalWords, Standing } from "../session/participation";
import { Controller } from "../session/session_controller";
import { Studies } from "../session/studies";
import { Uploads } from "../session/uploads";
import { Signal } from "../state/signal";
import type { Clock } from "../timing/clock";
import { Viewer } from "../viewer/viewer";
import { drawers } from "./drawers";
import { dropZone } from "./drop_zone";
import { covered } from "./insets";
import { SceneTools } from "./scene_tools";
import { Beside } from "./second_view";
import { shortcuts } from "./shortcuts";
import { testHook } from "./test_hook";

/** How often words and numbers follow the picture, and how often graphs do [ms]. */
const statusInterval = 200;
const graphInterval = 100;

/** What the page is about, as its address names it. */
export interface Subject {
  sessionId: string;
  /** A second session in a picture beside the first. */
  beside: string | undefined;
  /** Opens the page anew with this query. */
  open(query: string): void;
}

/** One session on one page: ties the connection, the picture and the panels together. */
export class App {
  private readonly frames = new Frames();
  private readonly looks = new Looks();
  private readonly report = new Signal<CompileReport | undefined>(undefined);
  private readonly presets = new Signal<Preset[]>([]);
  private readonly link = new Signal<Link>({ kind: "connecting" });
  private readonly controller: Controller;
  private readonly standing: Standing;
  private readonly lead: CameraLead;
  private readonly connection: Connection;
  private readonly viewer: Viewer;
  private readonly tools: SceneTools;
  private readonly graphs: Graphs;
  private readonly beside: Beside | undefined;
  private readonly margins = new Margins();
  private readonly pill: LinkPill;
  private readonly viewers = new ViewerCount();
  private readonly readout = new Readout();
  private readonly timeline = new Timeline(this.frames, (time) => this.lookBack(time));
  private readonly probes = new Probes();
  private readonly measures = new Measures();
  private readonly comparisons: Comparisons;
  private readonly exports: Exports;
  private readonly uploads: Uploads;
  private readonly comparison: ComparisonCard;
  private readonly bodies = new Signal<Body[]>([]);
  /** Where the dock began when that was looked at last [CSS pixels]. */
  private dockTop = 0;
  /** Names of the bodies that have mass and move by forces. */
  private deformable: ReadonlySet<string> = new Set();

  constructor(
    private readonly api: Api,
    private readonly subject: Subject,
    private readonly chooser: Chooser,
    identity: Identity,
    private readonly clock: Clock,
  ) {
    const { sessionId } = subject;
    this.controller = new Controller(api, sessionId, clock);
    this.standing = new Standing(api, this.controller, identity, clock);
    this.comparisons = new Comparisons(api, sessionId);
    this.exports = new Exports(api, sessionId);
    this.uploads = new Uploads(api);
    this.comparison = new ComparisonCard(this.comparisons);
    this.connection = new Connection(api, sessionId, this.sink(), clock);
    this.pill = new LinkPill(() => this.connection.retryNow());
    this.viewer = new Viewer(place("view") as HTMLCanvasElement, this.around());
    this.tools = new SceneTools(
      this.viewer,
      () => this.frames.moment?.arrays,
      this.looks,
      this.comparisons,
      new Forces(api, sessionId),
    );
    this.lead = new CameraLead(api, sessionId, this.standing, this.viewer.rig, clock);
    this.graphs = new Graphs(() => sessionId, this.tools.following);
    this.beside = this.openBeside();
    window.phrenic = testHook(() => this.bodies.value, this.frames, this.viewer);
  }

  start(): void {
    this.furnishStage();
    this.furnishPanel();
    this.furnishHeader();
    this.looks.all.subscribe((looks) => {
      for (const { layer, opacity, visible } of looks) this.viewer.setLayerOpacity(layer, visible ? opacity : 0);
    });
    // Who plays on has looked back enough.
    let playing = true;
    this.controller.session.subscribe((session) => {
      const [before, now] = [playing, session?.state === SessionState.PLAYING];
      playing = now;
      if (now && !before && this.timeline.back) this.lookBack(undefined);
    });
    setInterval(() => this.tell(), statusInterval);
    setInterval(() => document.hidden || this.draw(), graphInterval);
    window.addEventListener("pagehide", () => this.controller.leave());
    this.tools.coloring.kind.subscribe((kind) => this.connection.setExact(needsExact(kind)));
    void this.connection.run();
    void this.standing.run();
  }

  private around() {
    const reduced = matchMedia("(prefers-reduced-motion: reduce)");
    return {
      advance: () => this.frames.advance(this.clock.now(), reduced.matches),
      source: () => this.frames.moment?.arrays,
      update: (arrays: NonNullable<Frames["arrays"]>) => this.tools.update(this.frames.moment?.time ?? 0, arrays),
      drawn: (compass: Parameters<Margins["show"]>[0]) => {
        this.margins.show(compass);
        this.tools.drawn(compass);
        this.beside?.follow();
        this.lead.drawn();
      },
      covered,
      calm: () => reduced.matches,
    };
  }

  private openBeside(): Beside | undefined {
    const { sessionId, beside, open } = this.subject;
    if (beside === undefined || beside === sessionId) return undefined;
    const { viewer, frames, tools, looks, controller, presets } = this;
    const mayChange = () => refusalWords(this.standing.roles.value) === "";
    const first = { viewer, frames, tools, looks, controller, presets, around: this.around(), mayChange };
    return new Beside(this.api, beside, first, this.clock, {
      swap: () => open(`?${new URLSearchParams({ session: beside, beside: sessionId })}`),
      close: () => open(`?${new URLSearchParams({ session: sessionId })}`),
    });
  }

  private furnishStage(): void {
    const { controller, viewer, tools } = this;
    viewer.letPull(
      () => this.deformable,
      (body, vertex, force) => {
        const refused = refusalWords(this.standing.roles.value);
        if (refused === "") controller.pull(body, vertex, force);
        else controller.notice.set(refused);
      },
      (newtons, x, y) => tools.tellForce(newtons, x, y),
    );
    place("cards").append(...tools.cards, this.comparison.element);
    new ResizeObserver(() => this.resize()).observe(place("cards"));
    const drop = dropZone(document.body, (file) => void this.comparisons.compare(file));
    place("stage").append(drop, tools.force);
    if (this.beside !== undefined) {
      place("stage").classList.add("split");
      place("view").after(this.beside.element);
      place("stage").append(this.beside.heads.element);
      new ResizeObserver(() => this.resize()).observe(this.beside.heads.element);
    }
    place("annotations-place").append(tools.annotations.element);
    place("cube-place").append(tools.cube.element);
    place("playback-place").append(controlled(this.standing, playbackPanel(controller)));
    place("readout-place").append(this.timeline.element, this.readout.element);
    place("margins").append(...this.margins.elements);
    place("views").append(...viewBar(viewer, place("view")));
    place("banners").append(...banners(controller, this.link, () => void this.chooser.show()));
  }

  private furnishPanel(): void {
    const { controller, looks } = this;
    const [breathing, solver] = parameterSections(controller, this.report, this.presets);
    place("panel").append(
      compareWith(controller, this.presets, this.subject.open),
      controlled(this.standing, breathing),
      this.tools.panel,
      layersPanel(looks),
      controlled(this.standing, solver),
      streamPanel((codec) => this.connection.setCodec(codec)),
      this.probes.element,
      this.measures.element,
      comparePanel(this.comparisons, this.bodies, this.uploads.endings),
      studiesPanel(new Studies(this.api, this.clock), controller),
      exportPanel(this.exports, this.bodies),
      uploadPanel(this.uploads),
      reportPanel(this.report),
    );
    place("graphs").append(this.graphs.element);
  }

  private furnishHeader(): void {
    const { controller, viewer, report } = this;
    const { open, sessionId } = this.subject;
    const photograph = async () => {
      const picture = await viewer.photograph();
      if (picture !== null) download(`${sessionId}.png`, picture);
    };
    const share = new ShareDialog({ controller, report, open, photograph: () => void photograph() });
    const { graphs, panel } = drawers(() => this.resize(), this.beside !== undefined);
    const press = (id: string) => () => document.getElementById(id)?.click();
    const keys = shortcuts(
      [
        { key: " ", words: "Play, pause", act: press("play") },
        { key: ".", words: "Take some steps; one picture on where you look back", act: () => this.stepOn() },
        { key: ",", words: "Look back, one picture a time", act: () => this.timeline.turn(-1) },
        { key: "r", words: "Back to the start", act: press("reset") },
        { key: "g", words: "Graphs", act: graphs },
        { key: "c", words: "Controls", act: panel },
        { key: "h", words: "The whole scene", act: () => viewer.go("home") },
        { key: "f", words: "From the front", act: () => viewer.go("front") },
        { key: "p", words: "Save a picture", act: () => void photograph() },
        { key: "s", words: "Share, copy, compare", act: () => share.show() },
      ],
      () => controller.undo(),
      () => controller.redo(),
    );
    const control = new ControlDialog(this.standing, () => this.lead.follow());
    document.body.append(share.element, keys, control.element);
    place("share-open").onclick = () => share.show();
    place("help-open").onclick = () => keys.showModal();
    place("link-place").append(
      controlBadge(this.standing, () => control.show()),
      this.viewers.element,
      this.pill.element,
    );
    place("session-place").append(sessionButton(controller, () => void this.chooser.show()));
  }

  /** What the connection brings. */
  private sink(): Sink {
    return {
      link: (link) => this.link.set(link),
      session: (session, fresh) => this.controller.receive(session, fresh),
      frame: (frame) => {
        this.frames.receive(frame, this.clock.now());
        this.graphs.receive(frame);
        this.tools.receive(frame);
      },
      camera: (camera) => this.lead.receive(camera),
      basis: (basis) => this.frames.learn(basis),
      acknowledged: (response, sent, answered) => this.frames.acknowledged(response, sent, answered),
      scene: (bodies, report) => this.showScene(bodies, report),
    };
  }

  private showScene(bodies: Body[], report: CompileReport): void {
    this.comparisons.clear();
    this.bodies.set(bodies);
    this.frames.start(bodies);
    this.graphs.clear();
    this.report.set(report);
    this.deformable = new Set(report.bodies.filter(({ role }) => role === "deformable").map(({ name }) => name));
    this.comparisons.choose({ body: this.largestOf(bodies) });
    const diagram = this.viewer.show(bodies);
    this.looks.start(bodies, report);
    this.tools.start(bodies, this.deformable, diagram);
    place("loading").hidden = true;
  }

  /** What the simulation is about: of the deformable bodies the one with the most triangles. */
  private largestOf(bodies: Body[]): string {
    const moving = bodies.filter(({ name, triangles }) => this.deformable.has(name) && triangles.length > 0);
    return moving.sort((a, b) => b.triangles.length - a.triangles.length)[0]?.name ?? "";
  }

  private resize(): void {
    this.viewer.resize();
    this.beside?.resize();
  }

  private lookBack(time: number | undefined): void {
    this.frames.lookBack(time);
    this.beside?.lookBack(time);
    this.tools.lookBack(this.frames.lookedAt?.time);
  }

  private stepOn(): void {
    if (this.timeline.back) this.timeline.turn(1);
    else document.getElementById("step")?.click();
  }

  private draw(): void {
    this.graphs.draw();
    if (this.timeline.back) return;
    const session = this.controller.session.value;
    this.tools.askForces(`${this.frames.frame?.tick} ${session?.revision}`);
    this.beside?.askForces();
  }

  private tell(): void {
    if (document.hidden) return;
    const now = this.clock.now();
    const session = this.controller.session.value;
    const rate = this.frames.rate(now);
    const frame = this.frames.lookedAt ?? this.frames.present(now);
    const status = { link: this.link.value, session, frame, rate, now };
    this.pill.show(status);
    this.viewers.show(status);
    this.readout.show(status);
    this.probes.show(status.frame);
    this.timeline.show();
    // Words that take another line make the dock higher.
    if (place("dock").offsetTop !== this.dockTop) this.resize();
    this.dockTop = place("dock").offsetTop;
    this.beside?.tell(status.frame, now);
    this.measures.show(status.frame);
    this.comparison.show(status.frame?.time);
    this.tools.show();
  }
}
