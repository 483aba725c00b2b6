import { create } from "@bufbuild/protobuf";
import type { LayerStyles } from "../appearance/layer_styles";
import type { Identity } from "../connection/identity";
import { elementById } from "../dom/elements";
import { ownStorage } from "../dom/storage";
import type { Frame } from "../gen/phrenic/v1/frames_pb";
import { type Lesson, type LessonStep, LessonStepSchema, type LessonView } from "../gen/phrenic/v1/lesson_pb";
import type { Parameters } from "../gen/phrenic/v1/parameters_pb";
import type { CompileReport } from "../gen/phrenic/v1/report_pb";
import type { Preset } from "../gen/phrenic/v1/scene_pb";
import { valuesOf } from "../graphs/catalogue";
import type { ShownReferences } from "../graphs/references";
import { controlledGroup } from "../panels/session/control_dialog";
import { Choices } from "../panels/student/choices";
import { compareButton } from "../panels/student/compare_button";
import { LessonCard } from "../panels/student/lesson_card";
import { MotionSentence } from "../panels/student/motion_sentence";
import { PredictionPad } from "../panels/student/prediction_pad";
import { sliders } from "../panels/student/sliders";
import { StudentGraphsPanel } from "../panels/student/student_graphs_panel";
import { keptBreath } from "../parameters/kept_breath";
import { activeLabel } from "../parameters/presets";
import type { ClassAnswers } from "../session/class_answers";
import { fetchJson, type LessonPlace, presetOf, type SceneNames, withLessonPlace } from "../session/lessons";
import { OwnLessons } from "../session/own_lessons";
import { type PageView, rememberPageView, withPageView } from "../session/page_view";
import { type Participation, refusalReason } from "../session/participation";
import type { SessionController } from "../session/session_controller";
import { Signal } from "../state/signal";
import { TimeSeries } from "../state/time_series";
import { keptLessonView, showLessonView, whenShown } from "./lesson_scene";
import type { SceneTools } from "./scene_tools";
import type { SecondView } from "./second_view";
import { t } from "../language/translate";

/** Duration that is kept [simulated s]. */
const kept = 60;
/** End of the colour scale of a comparison [mm]: the domes of a quiet breath move by 7 to 13. */
const displacementTop = 20;

/** What the student view acts on. */
export interface StudentParts {
  controller: SessionController;
  participation: Participation;
  presets: Signal<Preset[]>;
  report: Signal<CompileReport | undefined>;
  answers: ClassAnswers;
  identity: Identity;
  tools: SceneTools;
  layerStyles: LayerStyles;
  secondView: SecondView | undefined;
  /** The lesson of the address. */
  lesson: LessonPlace | undefined;
  /** Opens the page with this query string. */
  open(query: string): void;
  /** What graphs show beside the breath; undefined before it is known. */
  references(): ShownReferences | undefined;
  /** Resolves when the samples up to now were recorded. */
  catchUp(): Promise<void>;
  /** Called when the layout has changed. */
  resized(): void;
}

/**
 * The page as a class sees it: choices, three sliders, two graphs and a sentence. A button changes to the expert view.
 */
export class StudentView {
  readonly element = elementById("student");
  readonly view: Signal<PageView>;
  private readonly history = new TimeSeries(kept);
  private readonly besideHistory = new TimeSeries(kept);
  private readonly graphs: StudentGraphsPanel;
  private readonly sentence = new MotionSentence();
  private readonly lessons: LessonCard;
  private readonly prediction: PredictionPad;
  /** What the lessons of this session may name, once the scene is shown. */
  private readonly names: Promise<SceneNames>;
  private gotFrame: (frame: Frame) => void = () => undefined;
  private readonly firstFrame = new Promise<Frame>((resolve) => (this.gotFrame = resolve));
  /** Why the samples of the session, and the one beside, cannot be read. */
  private readonly refusals = ["", ""];
  /** The view of the lesson's step, once there is a scene to show. */
  private lessonView: LessonView | undefined;

  constructor(
    private readonly parts: StudentParts,
    first: PageView,
  ) {
    const { controller, participation, presets, secondView } = parts;
    this.names = whenShown(controller.session, parts.layerStyles, this.firstFrame);
    const { answers, identity } = parts;
    const [teaches, refusal] = [new Signal(false), new Signal("")];
    participation.roles.subscribe((roles) => {
      teaches.set(roles.mayChange || roles.isOwner);
      refusal.set(refusalReason(roles));
    });
    this.lessons = new LessonCard({
      fetchFile: fetchJson,
      names: () => this.names,
      play: (lesson, step) => this.playStep(lesson, step),
      answer: (place, answer) => void answers.submit(place, answer),
      listAnswers: (lesson, names) => answers.list(lesson, names),
      teaches,
      own: new OwnLessons(identity.storage),
      keep: () => this.keepStep(),
      picture: () => parts.tools.pictureForPaper(),
      predicts: () => this.graphs.subjects.length > 0,
      predict: (measure, done) => this.prediction.predict(measure, done),
      refusal,
      print: () => window.print(),
      named: identity.isGraded,
    });
    const open = (query: string) => parts.open(withLessonPlace(query, this.lessons.place.value));
    this.view = new Signal(first);
    const beside = secondView && { history: this.besideHistory, label: () => this.besideLabel };
    this.graphs = new StudentGraphsPanel(this.history, beside, () => controller.sessionId, parts.references);
    const close =
      secondView &&
      (() => void secondView.end().then(() => open(`?${new URLSearchParams({ session: controller.sessionId })}`)));
    const compare = compareButton({ controller, presets, open, close });
    const choices = new Choices(controller, presets).element;
    const subjects = () => this.graphs.subjects;
    this.prediction = new PredictionPad({
      controller,
      history: this.history,
      subjects,
      catchUp: () => parts.catchUp(),
    });
    const [act, play] = [
      controlledGroup(participation, choices, compare),
      controlledGroup(participation, this.prediction.element),
    ];
    const efforts = controlledGroup(participation, sliders(controller));
    parts.report.subscribe((report) => {
      efforts.hidden = report?.idleParameters.includes("diaphragm_activation") ?? false;
    });
    // A comparison is read from its graphs: they come first.
    const rest = secondView === undefined ? [efforts, this.graphs.element] : [this.graphs.element, efforts];
    this.element.append(this.lessons.element, act, this.sentence.element, ...rest, play);
    this.view.subscribe((view) => this.show(view));
    this.lessons.place.subscribe((place) => {
      this.element.classList.toggle("in-lesson", place !== undefined);
      history.replaceState(null, "", withLessonPlace(location.search, place));
    });
    if (parts.lesson !== undefined) void this.lessons.start(parts.lesson);
    elementById("view-toggle").onclick = () => this.toggle();
  }

  /** Changes between the student and the expert view; the browser and the address remember it. */
  toggle(): void {
    const view = this.view.value === "student" ? "expert" : "student";
    rememberPageView(view, ownStorage);
    history.replaceState(null, "", withPageView(location.search, view));
    this.view.set(view);
    if (view === "student") this.showComparison();
  }

  /** Records the numbers of a sample of the session. */
  record(numbers: Frame, present: boolean): void {
    this.history.add(numbers.time, valuesOf(numbers), present);
  }

  /** Records the numbers of a sample of the session beside. */
  recordBeside(numbers: Frame, present: boolean): void {
    this.besideHistory.add(numbers.time, valuesOf(numbers), present);
  }

  /** Samples of the session are missing: begins new curves, and ends a prediction of the breath. */
  gap(): void {
    this.history.clear();
    this.prediction.interrupt();
  }

  /** Samples of the session beside are missing. */
  gapBeside(): void {
    this.besideHistory.clear();
  }

  /** Says why samples of the session, or the one beside, cannot be read; an empty reason if they can. */
  refused(reason: string, beside = false): void {
    this.refusals[Number(beside)] = reason;
    this.graphs.refused(this.refusals);
  }

  /** Reads from a frame what graphs and the sentence can show; a lesson waits for the first one. */
  receive(frame: Frame): void {
    this.sentence.receive(frame);
    this.graphs.receive(frame);
    this.gotFrame(frame);
  }

  /** Starts another scene, which the viewer shows already. */
  start(): void {
    this.history.clear();
    this.besideHistory.clear();
    if (this.view.value === "student") this.showComparison();
    if (this.lessonView !== undefined) showLessonView(this.lessonView, this.parts.tools, this.parts.layerStyles);
  }

  /** True if the student view shows a lesson. */
  get inLesson(): boolean {
    return this.view.value === "student" && this.lessons.place.value !== undefined;
  }

  /** Moves by a number of steps in the lesson. */
  moveInLesson(by: number): void {
    this.lessons.move(by);
  }

  /** Draws graphs and the sentence. */
  draw(): void {
    if (this.view.value !== "student") return;
    this.graphs.draw();
    this.prediction.draw();
    const source = (history: TimeSeries, parameters: () => Parameters | undefined) => ({ history, parameters });
    const { controller, secondView } = this.parts;
    const beside = secondView && {
      ...source(this.besideHistory, () => secondView.session.value?.parameters),
      label: this.besideLabel,
    };
    this.sentence.show(
      source(this.history, () => controller.session.value?.parameters),
      beside,
    );
  }

  /** The active preset of the second session. */
  private get besideLabel(): string {
    const { presets, secondView } = this.parts;
    return activeLabel(presets.value, secondView?.session.value?.parameters) ?? t("second view");
  }

  /** Sets the parameters of a step, if this viewer may, and shows its view. */
  private playStep(lesson: Lesson, step: LessonStep): void {
    const { controller, participation, tools, layerStyles } = this.parts;
    const preset = presetOf(lesson, step);
    const breath = preset !== "" || step.parameters !== undefined;
    if (participation.roles.value.mayChange && breath) void controller.usePreset(preset, step.parameters ?? {});
    this.lessonView = step.view;
    if (step.view !== undefined) showLessonView(step.view, tools, layerStyles);
  }

  /** Returns what is shown now as a step, without words. */
  private async keepStep(): Promise<LessonStep> {
    const { controller, presets, tools, layerStyles } = this.parts;
    const current = controller.session.value?.parameters;
    const breath = current && keptBreath(presets.value, await controller.startValues(), current);
    return create(LessonStepSchema, { ...breath, view: keptLessonView(tools, layerStyles) });
  }

  private show(view: PageView): void {
    document.body.classList.toggle("student", view === "student");
    const toggle = elementById("view-toggle");
    toggle.textContent = view === "student" ? t("Expert") : t("Student");
    toggle.title = view === "student" ? t("Show every control (E)") : t("Plain words and few controls (E)");
    this.parts.resized();
  }

  /**
   * Cuts both thoraxes in the coronal plane, colours them by displacement with one scale, and outlines the healthy
   * diaphragm in the other.
   */
  private showComparison(): void {
    const { tools, secondView } = this.parts;
    if (secondView === undefined) return;
    tools.cut.set({ kind: "coronal", fraction: 0.5, flipped: false });
    tools.coloring.choose("displacement");
    tools.coloring.setTop(displacementTop);
    tools.ghost.set("beside");
    tools.visit("front");
  }
}
