import { make } from "../../dom/elements";
import { alertMessage } from "../../dom/rows";
import { AnswerPhase } from "../../gen/phrenic/v1/answers_pb";
import type { Lesson, LessonStep, Question } from "../../gen/phrenic/v1/lesson_pb";
import type { GivenAnswer, QuestionPlace } from "../../session/class_answers";
import { checkLesson, type FetchJson, type LessonPlace, loadLesson, type SceneNames } from "../../session/lessons";
import type { OwnLessons } from "../../session/own_lessons";
import { Signal } from "../../state/signal";
import { ClassResults, type ListAnswers } from "./class_results";
import { LessonList } from "./lesson_list";
import type { LessonMaker } from "./lesson_maker";
import { differenceWords, lessonTest, questionCount, type Score } from "./lesson_test";
import { predictionForm, refusePrediction } from "./prediction_form";
import type { OnPredicted } from "./prediction_pad";
import { questionForm } from "./question_form";
import type { KeepView } from "./step_form";
import { StepPictures } from "./step_pictures";
import { t } from "../../language/translate";

/** What a lesson does to the page, and where it comes from. */
export interface LessonActions {
  fetchFile: FetchJson;
  /** Returns the scene of the session and its names, once it is shown. */
  names(): Promise<SceneNames>;
  /** Shows a step in the simulation. */
  play(lesson: Lesson, step: LessonStep): void;
  /** Sends an answer to the class. */
  answer(place: QuestionPlace, answer: GivenAnswer): void;
  listAnswers: ListAnswers;
  /** True if this viewer may see the answers of the class. */
  teaches: Signal<boolean>;
  own: OwnLessons;
  keep: KeepView;
  /** Returns a picture of the view, for paper. */
  picture(): Promise<Blob | null>;
  /** True if the scene has lungs. */
  predicts(): boolean;
  /** Has the user predict a measure and play the breath; false if the scene does not show it. */
  predict(measure: string, done: OnPredicted): boolean;
  /** Why this viewer may not play the session, so that nothing can be predicted; empty if it may. */
  refusal: Signal<string>;
  /** Prints the page. */
  print(): void;
  /** True if a school's platform knows who answers. */
  named: boolean;
}

/** The list of lessons, the lesson that is played, and the form that makes one. */
export class LessonCard {
  readonly element = make("section", { id: "lesson", ariaLabel: t("Lesson") });
  /** The lesson and step that are loaded or shown; undefined without a lesson. */
  readonly place = new Signal<LessonPlace | undefined>(undefined);
  private readonly list: LessonList;
  private readonly results: ClassResults;
  private lesson: Lesson | undefined;
  /** Of the test before the lesson; undefined if it was not taken. */
  private before: Score | undefined;
  private readonly pictures = new StepPictures();
  /** A lesson that was left before it was kept. */
  private draft: LessonMaker | undefined;

  constructor(private readonly actions: LessonActions) {
    this.list = new LessonList(actions, {
      start: (name) => void this.start({ name, step: 1 }),
      make: (lesson) => void this.make(lesson),
    });
    this.results = new ClassResults(actions.listAnswers);
    actions.teaches.subscribe((teaches) => this.results.element.classList.toggle("hidden", !teaches));
    actions.refusal.subscribe((words) => refusePrediction(this.element, words));
    this.showList();
  }

  /** Loads and starts a lesson at a step; a step beyond the end is the last one. */
  async start({ name, step }: LessonPlace): Promise<void> {
    this.lesson = this.before = undefined;
    this.pictures.clear();
    this.place.set({ name, step });
    try {
      const [lesson, names] = await Promise.all([this.load(name), this.actions.names()]);
      checkLesson(lesson, names);
      this.lesson = lesson;
      this.show({ name, step: Math.min(step, lesson.steps.length) });
    } catch (error) {
      this.leave();
      this.element.append(alertMessage(t("This lesson cannot be played: {0}.", (error as Error).message)));
    }
  }

  /** Moves by a number of steps; does nothing at the ends or without a lesson. */
  move(by: number): void {
    const { value } = this.place;
    if (value === undefined || this.lesson === undefined) return;
    const step = value.step + by;
    if (step < 1 || step > this.lesson.steps.length) return;
    void this.keepPicture();
    this.show({ ...value, step });
  }

  /** Keeps the view of the present step for the worksheet. */
  private async keepPicture(): Promise<void> {
    const { value } = this.place;
    if (value !== undefined) await this.pictures.keep(value.step, this.actions.picture());
  }

  private async print(): Promise<void> {
    const { lesson, actions } = this;
    if (lesson === undefined) return;
    await this.keepPicture();
    const { openWorksheet } = await import("./worksheet_page");
    const parts = { pictures: this.pictures.byStep, predicts: actions.predicts() };
    const closed = () => this.element.querySelector<HTMLElement>("#lesson-print")?.focus();
    openWorksheet(lesson, parts, { teaches: actions.teaches.value, print: () => actions.print(), closed });
  }

  private async load(name: string): Promise<Lesson> {
    const own = this.actions.own.get(name);
    if (own !== undefined) return own;
    if (name.startsWith("my-")) throw new Error(t("it is kept in another browser: open its file here"));
    return loadLesson(name, this.actions.fetchFile);
  }

  private show(place: LessonPlace): void {
    const { lesson } = this;
    const step = lesson?.steps[place.step - 1];
    if (lesson === undefined || step === undefined) return;
    this.place.set(place);
    const title = make("h3", { tabIndex: -1 }, step.title);
    const task = step.task === "" ? [] : [make("p", { className: "task" }, make("b", {}, t("Try: ")), step.task)];
    const answered = (answer: GivenAnswer) => this.send(place.step, AnswerPhase.UNSPECIFIED, answer);
    const question =
      step.question === undefined ? [] : [this.questionForm(step.question, answered), answerNote(this.actions.named)];
    const caption = make("p", { className: "caption" }, step.caption);
    const parts = [title, caption, ...task, ...question, ...this.testFirst(lesson, place)];
    const buttons = [this.buttons(place), this.printButton()];
    this.element.replaceChildren(this.head(lesson, place), ...parts, this.results.element, ...buttons);
    const asks = lesson.steps.some((each) => each.question !== undefined);
    refusePrediction(this.element, this.actions.refusal.value);
    this.results.show(asks ? { ...place, lesson } : undefined);
    title.focus();
    this.actions.play(lesson, step);
  }

  private questionForm(question: Question, answered: (answer: GivenAnswer) => void): HTMLElement {
    const predict = (measure: string, done: OnPredicted) => this.actions.predict(measure, done);
    return question.prediction === undefined
      ? questionForm(question, answered)
      : predictionForm(question, question.prediction, predict, answered);
  }

  private send(step: number, phase: AnswerPhase, answer: GivenAnswer): void {
    const lesson = this.place.value?.name;
    if (lesson !== undefined) this.actions.answer({ lesson, step, phase }, answer);
  }

  /** A button on the first step that asks all questions before the lesson. */
  private testFirst(lesson: Lesson, place: LessonPlace): HTMLElement[] {
    if (place.step > 1 || this.before !== undefined || questionCount(lesson) === 0) return [];
    const onclick = () =>
      this.showTest(AnswerPhase.BEFORE, (score) => {
        this.before = score;
        this.show(place);
      });
    return [make("button", { type: "button", id: "lesson-pretest", onclick }, t("Answer the questions first"))];
  }

  private showTest(phase: AnswerPhase.BEFORE | AnswerPhase.AFTER, done: (score: Score) => void): void {
    const { lesson } = this;
    if (lesson === undefined) return;
    const test = lessonTest(lesson, phase, (...answer) => this.send(...answer), done);
    const head = make("header", {}, make("h2", {}, lesson.title));
    const leave = make("button", { type: "button", onclick: () => this.leave() }, t("Leave"));
    this.element.replaceChildren(head, test, leave);
    test.querySelector<HTMLElement>("h3")?.focus();
  }

  /** The end of a lesson: the test after it, if there was one before. */
  private finish(): void {
    const { before } = this;
    if (before === undefined) return this.leave();
    this.showTest(AnswerPhase.AFTER, (after) => {
      this.leave();
      const words = make("p", { id: "lesson-difference" }, differenceWords(before, after));
      words.setAttribute("role", "status");
      this.element.prepend(words);
    });
  }

  private head(lesson: Lesson, { step }: LessonPlace): HTMLElement {
    const count = lesson.steps.length;
    const bar = make("progress", { max: count, value: step, ariaLabel: t("Progress of the lesson") });
    return make("header", {}, make("h2", {}, lesson.title), make("span", {}, t("Step {0} of {1}", step, count)), bar);
  }

  private buttons({ step }: LessonPlace): HTMLElement {
    const last = step === this.lesson?.steps.length;
    const back = make(
      "button",
      { type: "button", id: "lesson-back", onclick: () => this.move(-1) },
      t("Back |to the step before"),
    );
    back.disabled = step === 1;
    const next = make(
      "button",
      { type: "button", id: "lesson-next", className: "primary" },
      last ? t("Finish") : t("Next"),
    );
    next.onclick = () => (last ? this.finish() : this.move(1));
    const leave = make("button", { type: "button", id: "lesson-leave", onclick: () => this.leave() }, t("Leave"));
    return make("div", { className: "lesson-buttons" }, back, leave, next);
  }

  private printButton(): HTMLElement {
    const onclick = () => void this.print();
    return make("button", { type: "button", id: "lesson-print", onclick }, t("Print a worksheet"));
  }

  private leave(): void {
    this.lesson = this.before = undefined;
    this.pictures.clear();
    this.place.set(undefined);
    this.showList();
  }

  private showList(): void {
    this.results.show(undefined);
    this.list.close();
    this.element.replaceChildren(this.list.element);
  }

  private async make(first: Lesson | undefined): Promise<void> {
    const { own, keep, names } = this.actions;
    const [{ scene }, { LessonMaker: Maker }] = await Promise.all([names(), import("./lesson_maker")]);
    const save = (lesson: Lesson) => {
      const name = own.put(lesson);
      this.draft = undefined;
      return name;
    };
    const making = {
      keep,
      save,
      play: (name: string) => void this.start({ name, step: 1 }),
      leave: () => this.showList(),
    };
    if (first !== undefined || this.draft === undefined) this.draft = new Maker(making, scene, first);
    const { element } = this.draft;
    this.element.replaceChildren(element);
    element.querySelector("input")?.focus();
  }
}

function answerNote(named: boolean): HTMLElement {
  const words = named
    ? t("Your teacher can see your answer with your name, and it counts for your course.")
    : t("Your teacher can see your answer, with your name only if you gave one.");
  return make("p", { className: "faint" }, words);
}
