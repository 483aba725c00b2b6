import { clone, create } from "@bufbuild/protobuf";
import { make } from "../../dom/elements";
import { alertMessage, labelledRow } from "../../dom/rows";
import { type Lesson, LessonSchema } from "../../gen/phrenic/v1/lesson_pb";
import { faultOf } from "../../session/lesson_file";
import { saveAsFile } from "./save_lesson";
import { type KeepView, StepForm } from "./step_form";
import { t } from "../../language/translate";

/** What the maker of lessons needs from its page. */
export interface LessonMaking {
  keep: KeepView;
  /** Keeps a lesson in this browser and returns its name. Throws Error if there is no room. */
  save(lesson: Lesson): string;
  /** Plays a lesson of this browser. */
  play(name: string): void;
  /** Called when the maker is left. */
  leave(): void;
}

/** Makes a lesson about the scene that is shown: its steps are views that are kept one after the other. */
export class LessonMaker {
  readonly element = make("section", { id: "lesson-maker", ariaLabel: t("Make a lesson") });
  private readonly title = make("input", { type: "text", id: "maker-title", maxLength: 200 });
  private readonly summary = make("input", { type: "text", id: "maker-summary", maxLength: 500 });
  private readonly steps = make("ol", { id: "maker-steps" });
  private readonly words = make("div");
  private readonly lesson: Lesson;
  private readonly form: StepForm;

  /** Starts with a copy of a lesson, or an empty one about `scene`. */
  constructor(making: LessonMaking, scene: string, first?: Lesson) {
    this.lesson = first === undefined ? create(LessonSchema, { scene }) : clone(LessonSchema, first);
    this.title.value = this.lesson.title;
    this.summary.value = this.lesson.summary;
    this.form = new StepForm(making.keep, (step, before) => {
      const place = before === undefined ? -1 : this.lesson.steps.indexOf(before);
      if (place < 0) this.lesson.steps.push(step);
      else this.lesson.steps[place] = step;
      this.showSteps();
    });
    const buttons: [words: string, act: () => void][] = [
      [t("Save and play"), () => this.withLesson((lesson) => making.play(making.save(lesson)))],
      [
        t("Save in this browser"),
        () => this.withLesson((lesson) => this.tell(t("Kept as “{0}”.", making.save(lesson)))),
      ],
      [t("Save as file"), () => this.withLesson(saveAsFile)],
      [t("Leave"), () => making.leave()],
    ];
    const row = buttons.map(([words, onclick]) => make("button", { type: "button", onclick }, words));
    this.element.append(
      make("h2", {}, t("Make a lesson")),
      labelledRow("maker-title", t("Title"), this.title),
      labelledRow("maker-summary", t("What is learned"), this.summary),
      this.steps,
      this.form.element,
      this.words,
      make("div", { className: "maker-buttons" }, ...row),
    );
    this.showSteps();
  }

  private withLesson(act: (lesson: Lesson) => void): void {
    this.lesson.title = this.title.value.trim();
    this.lesson.summary = this.summary.value.trim();
    const fault = faultOf(this.lesson);
    if (fault !== undefined)
      return this.words.replaceChildren(alertMessage(t("The lesson is not complete: {0}.", fault)));
    try {
      act(this.lesson);
    } catch (error) {
      this.words.replaceChildren(alertMessage(`${(error as Error).message}.`));
    }
  }

  private tell(words: string): void {
    const told = make("p", {}, words);
    told.setAttribute("role", "status");
    this.words.replaceChildren(told);
  }

  private showSteps(): void {
    const { steps } = this.lesson;
    const rows = steps.map((step, i) => {
      const remove = () => {
        this.form.forget(step);
        steps.splice(i, 1);
        this.showSteps();
      };
      const earlier = () => {
        steps.splice(i - 1, 2, steps[i], steps[i - 1]);
        this.showSteps();
      };
      const change = () => this.form.edit(step);
      const buttons = [
        stepButton(t("Change"), i, change),
        stepButton(t("Remove"), i, remove),
        ...(i > 0 ? [stepButton(t("Earlier"), i, earlier)] : []),
      ];
      return make("li", {}, make("span", {}, step.title), ...buttons);
    });
    this.steps.replaceChildren(...rows);
    this.words.replaceChildren();
  }
}

function stepButton(verb: string, index: number, onclick: () => void): HTMLElement {
  const ariaLabel = t("{0}: step {1}", verb, index + 1);
  return make("button", { type: "button", className: "small", ariaLabel, onclick }, verb);
}
