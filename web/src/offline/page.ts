import { create } from "@bufbuild/protobuf";
import { filmStage } from "../app/film_stage";
import { stageInsets } from "../app/insets";
import { SceneStructures } from "../app/scene_structures";
import { LayerStyles } from "../appearance/layer_styles";
import { elementById, make } from "../dom/elements";
import { section } from "../dom/rows";
import { AnimatedPngWriter } from "../film/animated_png";
import { FilmMaker, type OpenWriter } from "../film/film_maker";
import { FilmWriter } from "../film/film_writer";
import { Clip } from "../frames/clip";
import type { DisplayedFrame } from "../frames/frame_buffer";
import type { OfflineMotion } from "../gen/phrenic/v1/offline_pb";
import { CompileReportSchema } from "../gen/phrenic/v1/report_pb";
import * as simplifier from "../geometry/simplified";
import { animationButton, filmButton } from "../panels/jobs/take_home";
import { cutRows } from "../panels/view/cut_rows";
import { layersPanel } from "../panels/view/layers_panel";
import { Margins } from "../panels/view/margins";
import { OrientationCube } from "../panels/view/orientation_cube";
import { viewBar } from "../panels/view/view_bar";
import { motionTitle } from "../parameters/presets";
import type { ExportProgress } from "../session/exports";
import { Signal } from "../state/signal";
import type { Cut } from "../viewer/clipping";
import { viewNames } from "../viewer/named_views";
import { Viewer } from "../viewer/viewer";
import { type Viewpoint, viewpoints } from "../viewer/viewpoints";
import { BreathGraphs } from "./breath_graphs";
import { factsSection } from "./facts";
import { playback, scrubber } from "./playback";
import { Player } from "./player";
import { t } from "../language/translate";

const idle = () => new Signal<ExportProgress>({ kind: "idle" });

/** Shows a motion on the page: the scene with its layers, views and cuts, playback, graphs and facts. */
export class MotionPage {
  private readonly clip: Clip;
  private readonly player: Player;
  private readonly viewer: Viewer;
  private readonly graphs: BreathGraphs;
  private readonly margins = new Margins();
  private readonly layerStyles = new LayerStyles();
  private readonly structures: SceneStructures;
  private readonly cut = new Signal<Cut>({ kind: "none", fraction: 0.5, flipped: false });
  private readonly viewpoints = new Signal<Viewpoint[]>([]);
  private readonly cube = new OrientationCube((view) => this.visit(view));

  /** The frame of a film that is drawn; undefined while no film is made. */
  private filmed: DisplayedFrame | undefined;

  /**
   * `decoder` is the compiled decoder. Throws RangeError for a motion that is not valid, and Error if the browser has
   * no WebGL 2.
   */
  constructor(
    private readonly decoder: WebAssembly.Module,
    private readonly motion: OfflineMotion,
  ) {
    this.clip = new Clip(decoder, motion.frames, motion.bodies);
    this.player = new Player(this.clip.length);
    this.graphs = new BreathGraphs(motion.frames, this.clip.times, motion.scene);
    this.viewer = new Viewer(elementById("view") as HTMLCanvasElement, this.host());
    this.structures = new SceneStructures(this.viewer, this.layerStyles);
  }

  /** Builds the page, and plays unless the user prefers reduced motion. */
  start(): void {
    this.buildTexts();
    this.buildStage();
    this.buildPanels();
    this.showScene();
    addEventListener("keydown", (event) => this.onKey(event));
    matchMedia("(prefers-color-scheme: light)").addEventListener("change", () => this.drawGraphs());
    elementById("loading").hidden = true;
    this.drawGraphs();
    this.player.time.subscribe((time) => this.graphs.mark(time, this.clip.indexAt(time)));
    this.player.setPlaying(!matchMedia("(prefers-reduced-motion: reduce)").matches);
  }

  private host() {
    const reduced = matchMedia("(prefers-reduced-motion: reduce)");
    return {
      advance: () => this.player.advance(performance.now()),
      frame: () => this.filmed?.arrays ?? this.clip.at(this.player.time.value),
      afterDraw: (orientation: Parameters<Margins["show"]>[0]) => {
        this.margins.show(orientation);
        this.cube.show(orientation);
      },
      insets: () => stageInsets(false),
      reducedMotion: () => reduced.matches,
      simplifier: () => Promise.resolve(simplifier),
    };
  }

  private buildTexts(): void {
    const { scene, preset } = motionTitle(this.motion);
    document.title = preset === "" ? t("{0} – Phrenic", scene) : t("{0}, {1} – Phrenic", scene, preset.toLowerCase());
    elementById("motion-title").textContent = scene;
    elementById("motion-preset").textContent = preset;
  }

  private buildStage(): void {
    const { viewer, player, clip } = this;
    const bar = viewBar(viewer, elementById("view"), this.viewpoints, (name) => this.visit(name));
    elementById("views").append(...bar, this.structures.search);
    elementById("cards").append(this.structures.card);
    new ResizeObserver(() => viewer.resize()).observe(elementById("cards"));
    elementById("stage").append(this.structures.label);
    elementById("cube-slot").append(this.cube.element);
    elementById("margins").append(...this.margins.elements);
    elementById("playback-slot").append(playback(player));
    elementById("readout-slot").append(scrubber(player, clip.length));
    viewer.enablePicking((vertex) => this.structures.choose(vertex));
    player.time.subscribe(() => viewer.refresh());
  }

  private buildPanels(): void {
    elementById("graphs").append(this.graphs.element);
    const cuts = section(t("Cut"), false, ...cutRows(this.cut, (cut) => this.viewer.cutCoordinate(cut)));
    elementById("panel").append(factsSection(this.motion), layersPanel(this.layerStyles), cuts, this.filmSection());
  }

  private filmSection(): HTMLElement {
    const source = {
      progress: idle(),
      decoder: async () => this.decoder,
      record: async () => this.motion,
      stop: () => undefined,
    };
    const stage = filmStage(this.viewer, undefined, (frame) => (this.filmed = frame));
    const film = filmButton(new FilmMaker(source, stage, (...of) => FilmWriter.open(...of)));
    const openPng: OpenWriter = (...of) => Promise.resolve(AnimatedPngWriter.open(...of));
    const animation = animationButton(FilmMaker.ofAnimations({ ...source, progress: idle() }, stage, openPng));
    const pictures = t("The same as an animated PNG, for pages and messages.");
    const detail = make("p", { className: "faint" }, t("A WebM video of the breath as the view shows it, for slides."));
    return section(
      t("A film of this breath"),
      false,
      detail,
      film.lines,
      film.go,
      film.progress,
      make("p", { className: "faint" }, pictures),
      animation.go,
      animation.progress,
    );
  }

  private showScene(): void {
    const { viewer, clip, layerStyles } = this;
    viewer.show(clip.bodies);
    layerStyles.start(clip.bodies, this.motion.report ?? create(CompileReportSchema));
    layerStyles.all.subscribe((styles) => {
      for (const { layer, opacity, visible } of styles) viewer.setLayerOpacity(layer, visible ? opacity : 0);
    });
    this.cut.subscribe((cut) => viewer.setCut(cut));
    this.viewpoints.set(viewpoints(clip.bodies, viewer.bounds));
    this.structures.start(clip.bodies);
  }

  /** Shows a named view; unknown names change nothing. */
  private visit(name: string): void {
    const viewpoint = this.viewpoints.value.find((each) => each.name === name);
    const view = viewpoint?.view ?? viewNames.find((each) => each === name);
    if (view === undefined) return;
    this.cut.set(viewpoint?.cut ?? { ...this.cut.value, kind: "none" });
    this.viewer.goTo(view);
  }

  private onKey(event: KeyboardEvent): void {
    const { key, target, ctrlKey, metaKey, altKey } = event;
    if (ctrlKey || metaKey || altKey || (target as Element | null)?.closest("input, select, button, summary")) return;
    const viewpoint = this.viewpoints.value.find((each) => each.key === key);
    if (viewpoint !== undefined) this.visit(viewpoint.name);
    else if (key === "h") this.visit("home");
    else if (key === "Escape") this.structures.showAll();
    else if (key === " ") this.player.setPlaying(!this.player.playing.value);
    else return;
    event.preventDefault();
  }

  private drawGraphs(): void {
    this.graphs.draw();
    this.graphs.mark(this.player.time.value, this.clip.indexAt(this.player.time.value));
  }
}
