import type { Api } from "./api";
import type { Clock } from "./clock";
import type { Body, FrameArrays } from "./codec";
import { type Comparison, Comparisons } from "./comparison";
import { Connection, type Link, type Sink } from "./connection";
import { Controller } from "./controller";
import { DistanceScale, topFor } from "./distance_scale";
import { Exports } from "./exports";
import { Frames } from "./frames";
import type { CompileReport } from "./gen/phrenic/v1/report_pb";
import { Looks } from "./looks";
import { appearancePanel, layersPanel } from "./panels/appearance";
import { banners } from "./panels/banner";
import type { Chooser } from "./panels/chooser";
import { comparePanel } from "./panels/compare";
import { ComparisonCard } from "./panels/comparison_card";
import { make, place } from "./panels/dom";
import { dropZone } from "./panels/drop_zone";
import { exportPanel } from "./panels/export";
import { Margins } from "./panels/margins";
import { Measures } from "./panels/measures";
import { parameterSections } from "./panels/parameters";
import { playbackPanel } from "./panels/playback";
import { Probes } from "./panels/probes";
import { reportPanel } from "./panels/report";
import { LinkPill, Readout, ViewerCount } from "./panels/status";
import { uploadPanel } from "./panels/upload";
import { viewBar } from "./panels/view_bar";
import { Signal } from "./signal";
import { testHook } from "./test_hook";
import { Uploads } from "./uploads";
import type { Covered } from "./viewer/rig";
import { Viewer } from "./viewer/viewer";

/** How often words and numbers follow the picture [ms]. */
const statusInterval = 200;

/** One session on one page: ties the connection, the picture and the panels together. */
export class App {
  private readonly frames = new Frames();
  private readonly looks = new Looks();
  private readonly report = new Signal<CompileReport | undefined>(undefined);
  private readonly link = new Signal<Link>({ kind: "connecting" });
  private readonly controller: Controller;
  private readonly connection: Connection;
  private readonly viewer: Viewer;
  private readonly margins = new Margins();
  private readonly pill: LinkPill;
  private readonly viewers = new ViewerCount();
  private readonly readout = new Readout();
  private readonly probes = new Probes();
  private readonly measures = new Measures();
  private readonly comparisons: Comparisons;
  private readonly exports: Exports;
  private readonly uploads: Uploads;
  private readonly comparison: ComparisonCard;
  private readonly bodies = new Signal<Body[]>([]);
  /** Names of the bodies that have mass and move by forces. */
  private deformable: ReadonlySet<string> = new Set();

  constructor(
    api: Api,
    sessionId: string,
    private readonly chooser: Chooser,
    private readonly clock: Clock,
  ) {
    this.controller = new Controller(api, sessionId, clock);
    this.comparisons = new Comparisons(api, sessionId);
    this.exports = new Exports(api, sessionId);
    this.uploads = new Uploads(api);
    this.comparison = new ComparisonCard(this.comparisons);
    this.connection = new Connection(api, sessionId, this.sink(), clock);
    this.pill = new LinkPill(() => this.connection.retryNow());
    place("comparison-place").append(this.comparison.element);
    const reduced = matchMedia("(prefers-reduced-motion: reduce)");
    this.viewer = new Viewer(
      place("view") as HTMLCanvasElement,
      () => this.arrays(),
      (compass) => this.margins.show(compass),
      covered,
      () => reduced.matches,
    );
    window.phrenic = testHook(() => this.bodies.value, this.frames, this.viewer);
  }

  start(): void {
    this.furnish();
    this.looks.all.subscribe((looks) => {
      for (const { layer, opacity, visible } of looks) this.viewer.setLayerOpacity(layer, visible ? opacity : 0);
    });
    this.comparisons.result.subscribe((comparison) => this.viewer.paint(painted(comparison)));
    setInterval(() => this.tell(), statusInterval);
    void this.connection.run();
  }

  private furnish(): void {
    const { controller, looks, viewer } = this;
    place("panel").append(
      ...parameterSections(controller, this.report),
      appearancePanel(looks, (kind, on) => viewer.setOverlay(kind, on)),
      layersPanel(looks),
      comparePanel(this.comparisons, this.bodies, this.uploads.endings),
      exportPanel(this.exports, this.bodies),
      uploadPanel(this.uploads),
      this.probes.element,
      this.measures.element,
      reportPanel(this.report),
    );
    viewer.letPull(
      () => this.deformable,
      (body, vertex, force) => controller.pull(body, vertex, force),
    );
    window.addEventListener("pagehide", () => controller.leave());
    const drop = dropZone(document.body, (file) => void this.comparisons.compare(file));
    place("stage").append(drop);
    new ResizeObserver(() => viewer.resize()).observe(this.comparison.element);
    place("playback-place").append(playbackPanel(controller));
    place("readout-place").append(this.readout.element);
    place("link-place").append(this.viewers.element, this.pill.element);
    place("session-place").append(this.sessionButton());
    place("margins").append(...this.margins.elements);
    place("views").append(...viewBar(viewer, place("view")));
    place("banners").append(...banners(controller, this.link, () => void this.chooser.show()));
    foldPanel(place("panel-toggle") as HTMLButtonElement);
  }

  private sessionButton(): HTMLElement {
    const title = make("b");
    const id = make("span");
    this.controller.session.subscribe((session) => {
      title.textContent = session?.sceneTitle || session?.scene || "";
      id.textContent = session?.id ?? "";
    });
    const open = () => void this.chooser.show();
    return make("button", { type: "button", id: "session", title: "Sessions and scenes", onclick: open }, title, id);
  }

  /** What the connection brings. */
  private sink(): Sink {
    return {
      link: (link) => this.link.set(link),
      session: (session, fresh) => this.controller.receive(session, fresh),
      frame: (frame) => {
        this.frames.receive(frame, this.clock.now());
        this.probes.receive(frame);
        this.viewer.refresh();
      },
      acknowledged: (response, sent, answered) => this.frames.acknowledged(response, sent, answered),
      scene: (bodies, report) => {
        this.comparisons.clear();
        this.bodies.set(bodies);
        this.frames.start(bodies);
        this.report.set(report);
        this.deformable = new Set(report?.bodies.filter(({ role }) => role === "deformable").map(({ name }) => name));
        this.comparisons.choose({ body: this.largestOf(bodies) });
        this.viewer.show(bodies);
        this.looks.start(bodies, report);
        place("loading").hidden = true;
      },
    };
  }

  /** What the simulation is about: of the deformable bodies the one with the most triangles. */
  private largestOf(bodies: Body[]): string {
    const moving = bodies.filter(({ name, triangles }) => this.deformable.has(name) && triangles.length > 0);
    return moving.sort((a, b) => b.triangles.length - a.triangles.length)[0]?.name ?? "";
  }

  private arrays(): FrameArrays | undefined {
    return this.frames.arrays;
  }

  private tell(): void {
    if (document.hidden) return;
    const now = this.clock.now();
    const session = this.controller.session.value;
    const rate = this.frames.rate(now);
    const status = { link: this.link.value, session, frame: this.frames.frame, rate, now };
    this.pill.show(status);
    this.viewers.show(status);
    this.readout.show(status);
    this.probes.show(status.frame);
    this.measures.show(status.frame);
    this.comparison.show(status.frame?.time);
  }
}

function painted(comparison: Comparison | undefined): { body: string; rgb: Uint8Array } | undefined {
  if (comparison === undefined) return undefined;
  const { body, distances } = comparison;
  return { body, rgb: new DistanceScale(topFor(distances)).paint(distances) };
}

/** How much of the picture lies under view buttons, dock and card [CSS pixels]; the style sheet hears of it too. */
function covered(): Covered {
  const stage = place("stage");
  const bottom = stage.clientHeight - place("dock").offsetTop;
  const { offsetLeft, offsetWidth } = place("comparison");
  // Where a card takes most of a narrow picture, the scene stays behind it.
  const left = offsetLeft + offsetWidth < 0.6 * stage.clientWidth ? offsetLeft + offsetWidth : 0;
  stage.style.setProperty("--covered", `${bottom}px`);
  stage.style.setProperty("--covered-left", `${left}px`);
  return { left, top: 48, bottom };
}

/** The panel folds away; on a narrow screen it starts folded. */
function foldPanel(toggle: HTMLButtonElement): void {
  const fold = (open: boolean) => {
    document.body.classList.toggle("panel-open", open);
    toggle.setAttribute("aria-expanded", String(open));
  };
  toggle.onclick = () => fold(!document.body.classList.contains("panel-open"));
  fold(!matchMedia("(max-width: 760px)").matches);
}
