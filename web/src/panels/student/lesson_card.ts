import { make } from "../../dom/elements";
import { alertMessage } from "../../dom/rows";
import type { Lesson, LessonStep } from "../../gen/phrenic/v1/lesson_pb";
import {
  checkLesson,
  type FetchJson,
  lessonNames,
  type LessonPlace,
  loadLesson,
  type SceneNames,
} from "../../session/lessons";
import { Signal } from "../../state/signal";
import { questionForm } from "./question_form";

/** What a lesson does to the page. */
export interface LessonActions {
  fetchFile: FetchJson;
  /** Returns the scene of the session and its names, once it is shown. */
  names(): Promise<SceneNames>;
  /** Shows a step in the simulation. */
  play(lesson: Lesson, step: LessonStep): void;
}

/** The list of lessons, and the lesson that is played: caption, task, question, progress, next and back. */
export class LessonCard {
  readonly element = make("section", { id: "lesson", ariaLabel: "Lesson" });
  /** The lesson and step that are loaded or shown; undefined without a lesson. */
  readonly place = new Signal<LessonPlace | undefined>(undefined);
  private lesson: Lesson | undefined;

  constructor(private readonly actions: LessonActions) {
    this.showList();
  }

  /** Loads and starts a lesson at a step; a step beyond the end is the last one. */
  async start({ name, step }: LessonPlace): Promise<void> {
    this.lesson = undefined;
    this.place.set({ name, step });
    try {
      const [lesson, names] = await Promise.all([loadLesson(name, this.actions.fetchFile), this.actions.names()]);
      checkLesson(lesson, names);
      this.lesson = lesson;
      this.show({ name, step: Math.min(step, lesson.steps.length) });
    } catch (error) {
      this.leave();
      this.element.append(alertMessage(`This lesson cannot be played: ${(error as Error).message}.`));
    }
  }

  /** Moves by a number of steps; does nothing at the ends or without a lesson. */
  move(by: number): void {
    const { value } = this.place;
    if (value === undefined || this.lesson === undefined) return;
    const step = value.step + by;
    if (step >= 1 && step <= this.lesson.steps.length) this.show({ ...value, step });
  }

  private show(place: LessonPlace): void {
    const { lesson } = this;
    const step = lesson?.steps[place.step - 1];
    if (lesson === undefined || step === undefined) return;
    this.place.set(place);
    const title = make("h3", { tabIndex: -1 }, step.title);
    const task = step.task === "" ? [] : [make("p", { className: "task" }, make("b", {}, "Try: "), step.task)];
    const question = step.question === undefined ? [] : [questionForm(step.question)];
    const caption = make("p", { className: "caption" }, step.caption);
    this.element.replaceChildren(this.head(lesson, place), title, caption, ...task, ...question, this.buttons(place));
    title.focus();
    this.actions.play(lesson, step);
  }

  private head(lesson: Lesson, { step }: LessonPlace): HTMLElement {
    const count = lesson.steps.length;
    const bar = make("progress", { max: count, value: step, ariaLabel: "Progress of the lesson" });
    return make("header", {}, make("h2", {}, lesson.title), make("span", {}, `Step ${step} of ${count}`), bar);
  }

  private buttons({ step }: LessonPlace): HTMLElement {
    const last = step === this.lesson?.steps.length;
    const back = make("button", { type: "button", id: "lesson-back", onclick: () => this.move(-1) }, "Back");
    back.disabled = step === 1;
    const next = make("button", { type: "button", id: "lesson-next", className: "primary" }, last ? "Finish" : "Next");
    next.onclick = () => (last ? this.leave() : this.move(1));
    const leave = make("button", { type: "button", id: "lesson-leave", onclick: () => this.leave() }, "Leave");
    return make("div", { className: "lesson-buttons" }, back, leave, next);
  }

  private leave(): void {
    this.lesson = undefined;
    this.place.set(undefined);
    this.showList();
  }

  /** The list of the lessons about this scene is loaded when it is opened first. */
  private showList(): void {
    const list = make("ul");
    const summary = make("summary", {}, "Lessons");
    const fold = make("details", { id: "lessons" }, summary, list);
    fold.ontoggle = () => {
      if (fold.open && list.childElementCount === 0) void this.fill(list);
    };
    this.element.replaceChildren(fold);
  }

  private async fill(list: HTMLElement): Promise<void> {
    try {
      const names = await lessonNames(this.actions.fetchFile);
      const lessons = await Promise.all(names.map((name) => loadLesson(name, this.actions.fetchFile)));
      const { scene } = await this.actions.names();
      const rows = lessons.flatMap((lesson, i) => (lesson.scene === scene ? [this.row(names[i], lesson)] : []));
      const none = make("li", {}, `There is no lesson about the scene “${scene}”.`);
      list.replaceChildren(...(rows.length > 0 ? rows : [none]));
    } catch (error) {
      list.replaceChildren(make("li", {}, alertMessage(`The lessons cannot be listed: ${(error as Error).message}.`)));
    }
  }

  private row(name: string, { title, summary }: Lesson): HTMLElement {
    const onclick = () => void this.start({ name, step: 1 });
    const words = [make("b", {}, title), make("span", {}, summary)];
    const open = make("button", { type: "button", onclick }, ...words);
    open.dataset.lesson = name;
    return make("li", {}, open);
  }
}
