import { create } from "@bufbuild/protobuf";
import { make } from "../../dom/elements";
import { alertMessage, labelledRow } from "../../dom/rows";
import { type LessonStep, LessonStepSchema, type Question, QuestionSchema } from "../../gen/phrenic/v1/lesson_pb";
import { faultOfStep } from "../../session/lesson_file";
import { t } from "../../language/translate";

/** What is shown now: view, preset and parameters, without words. */
export type KeepView = () => Promise<LessonStep>;

/** Returns a labelled field for a text of several lines. */
function textRow(id: string, label: string, placeholder = ""): { row: HTMLElement; field: HTMLTextAreaElement } {
  const field = make("textarea", { id, rows: 3, maxLength: 2000, placeholder });
  return { row: make("div", { className: "text-row" }, make("label", { htmlFor: id }, label), field), field };
}

/** A form that keeps what is shown as a step of a lesson, with a title, a caption, a task and a question. */
export class StepForm {
  readonly element = make("form", { id: "step-form" });
  private readonly title = make("input", { type: "text", id: "step-title", maxLength: 200 });
  private readonly caption = textRow("step-caption", t("Caption: what is seen, and why"));
  private readonly task = textRow("step-task", t("Task (may be empty)"));
  private readonly words = make("input", { type: "text", id: "step-question", maxLength: 500 });
  private readonly answers = textRow(
    "step-answers",
    t(
      "Answers: one a line, * before each right one; or one number, ± and its tolerance, and its unit; or a curve: predict lung volume ± 0.3",
    ),
    t("The left half pushes it.\n* It cannot pull against the pressure."),
  );
  private readonly explanation = make("input", { type: "text", id: "step-explanation", maxLength: 1000 });
  private readonly question = make("details");
  private readonly fault = make("div");
  private readonly submit = make("button", { type: "submit", id: "keep-view" });
  private readonly cancel = make("button", { type: "button", id: "keep-old-words" }, t("Cancel"));
  /** The kept step whose words are changed; undefined while the next step is made. */
  private edited: LessonStep | undefined;

  /** Calls `done` with each step that is kept, and with the one that it replaces if only its words were changed. */
  constructor(
    private readonly keep: KeepView,
    private readonly done: (step: LessonStep, before: LessonStep | undefined) => void,
  ) {
    this.question.append(
      make("summary", {}, t("A question")),
      labelledRow("step-question", t("Question"), this.words),
      this.answers.row,
      labelledRow("step-explanation", t("Why it is right"), this.explanation),
    );
    const rows = [labelledRow("step-title", t("Title of the step"), this.title), this.caption.row, this.task.row];
    this.element.append(...rows, this.question, this.fault, this.submit, this.cancel);
    this.cancel.onclick = () => this.begin(undefined);
    this.begin(undefined);
    this.element.onsubmit = (event) => {
      event.preventDefault();
      void this.finish();
    };
  }

  /** Shows the words of a kept step to change them; its view stays as it was kept. */
  edit(step: LessonStep): void {
    this.begin(step);
    this.title.focus();
  }

  /** Leaves the words of a step that is removed. */
  forget(step: LessonStep): void {
    if (step === this.edited) this.begin(undefined);
  }

  private begin(step: LessonStep | undefined): void {
    this.edited = step;
    this.element.reset();
    this.fault.replaceChildren();
    this.submit.textContent = step === undefined ? t("Keep this view as a step") : t("Change the words of this step");
    this.cancel.hidden = step === undefined;
    if (step === undefined) return;
    const { title, caption, task, question } = step;
    [this.title.value, this.caption.field.value, this.task.field.value] = [title, caption, task];
    this.question.open = question !== undefined;
    this.words.value = question?.words ?? "";
    this.explanation.value = question?.explanation ?? "";
    this.answers.field.value = question === undefined ? "" : answersText(question);
  }

  private async finish(): Promise<void> {
    const before = this.edited;
    const step = create(LessonStepSchema, { ...(before ?? (await this.keep())), ...this.texts() });
    const fault = this.questionFault() ?? faultOfStep(step);
    this.fault.replaceChildren(
      ...(fault === undefined ? [] : [alertMessage(t("The step cannot be kept: {0}.", fault))]),
    );
    if (fault !== undefined) return;
    this.begin(undefined);
    this.done(step, before);
  }

  private texts() {
    const question = this.words.value.trim() === "" ? undefined : this.asked();
    const [title, caption, task] = [this.title, this.caption.field, this.task.field].map(({ value }) => value.trim());
    return { title, caption, task, question };
  }

  /** Answers without a question would be lost. */
  private questionFault(): string | undefined {
    const lost = this.words.value.trim() === "" && this.answers.field.value.trim() !== "";
    return lost ? t("question.words: there are answers without a question") : undefined;
  }

  private asked() {
    const [words, explanation] = [this.words.value.trim(), this.explanation.value.trim()];
    return create(QuestionSchema, { words, explanation, ...answersOf(this.answers.field.value) });
  }
}

/** Returns the answers of a question as `answersOf` reads them. */
export function answersText({ answers, number, prediction }: Question): string {
  if (prediction !== undefined) return `predict ${prediction.measure} ± ${prediction.tolerance}`;
  if (number !== undefined) return `${number.value} ± ${number.tolerance} ${number.unit}`.trim();
  return answers.map(({ words, right }) => (right ? `* ${words}` : words)).join("\n");
}

/**
 * Returns the answers of a text, one a line with "*" before right ones; a number, as "1.5 ± 0.2 l"; or a curve to draw,
 * as "predict right dome ± 4".
 */
export function answersOf(text: string) {
  const curve = /^predict\s+([^\n±]*[^\s±])\s*(?:±|\+-)\s*(\d+(?:\.\d+)?)$/.exec(text.trim());
  if (curve !== null) return { prediction: { measure: curve[1], tolerance: Number(curve[2]) } };
  const number = /^([-−]?\d+(?:\.\d+)?)\s*(?:(?:±|\+-)\s*(\d+(?:\.\d+)?))?\s*([^\d\s*][^\n]*)?$/.exec(text.trim());
  if (number !== null) {
    const [, value, tolerance = "0", unit = ""] = number;
    return { number: { value: Number(value.replace("−", "-")), tolerance: Number(tolerance), unit: unit.trim() } };
  }
  const lines = text.split("\n").map((line) => line.trim()).filter((line) => line !== ""); // prettier-ignore
  return { answers: lines.map((line) => ({ words: line.replace(/^\*\s*/, ""), right: line.startsWith("*") })) };
}
