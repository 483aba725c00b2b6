import { download } from "../../dom/download";
import { make } from "../../dom/elements";
import { alertMessage, switchRow } from "../../dom/rows";
import { AnswerPhase, type ClassAnswer } from "../../gen/phrenic/v1/answers_pb";
import type { Lesson, Question } from "../../gen/phrenic/v1/lesson_pb";
import { answersCsv, compareTests, summaryOf } from "../../session/answer_summary";
import { decimal, t } from "../../language/translate";

/** Time between two questions to the server while the results are open [ms]. */
const refreshInterval = 2000;

/** Returns the class's answers to the lesson of this name. */
export type ListAnswers = (lesson: string, includeNames: boolean) => Promise<ClassAnswer[]>;

/** The answers of the class to the question of a step, as they come, without names unless they are asked for. */
export class ClassResults {
  readonly element = make("details", { id: "class-results" });
  private readonly body = make("div", { className: "class-results" });
  /** Why names are refused. */
  private readonly fault = make("div");
  private readonly names: HTMLInputElement;
  private readonly tools: HTMLElement;
  /** Requests without an answer. */
  private pending = 0;
  private timer: ReturnType<typeof setInterval> | undefined;
  private shown: { name: string; lesson: Lesson; step: number } | undefined;
  private answers: ClassAnswer[] = [];

  constructor(private readonly list: ListAnswers) {
    const help = t("Shows who gave which answer, of those who gave a name");
    const { row, input } = switchRow(t("Names"), help, () => {
      this.fault.replaceChildren();
      void this.refresh();
    });
    this.names = input;
    const save = make("button", { type: "button", onclick: () => this.save() }, t("Save as CSV"));
    this.tools = make("div", { className: "row" }, row, save);
    this.element.append(make("summary", {}, t("Answers of the class")), this.body, this.fault, this.tools);
    this.element.ontoggle = () => this.watch();
  }

  /** Shows the answers to the question of a step, from 1; undefined hides the results. */
  show(shown: { name: string; lesson: Lesson; step: number } | undefined): void {
    this.shown = shown;
    this.element.hidden = shown === undefined;
    this.watch();
  }

  /** Asks the server while the results are open and on the page. */
  private watch(): void {
    clearInterval(this.timer);
    this.timer = undefined;
    if (!this.element.open || this.shown === undefined) return;
    // A server that reads the names of a course answers late: a timer asks only after the last answer.
    this.timer = setInterval(() => {
      if (this.pending === 0) void this.refresh();
    }, refreshInterval);
    void this.refresh();
  }

  private async refresh(): Promise<void> {
    const { shown } = this;
    if (shown === undefined || !this.element.isConnected) return this.stop();
    this.pending += 1;
    try {
      const answers = await this.list(shown.name, this.names.checked);
      if (shown !== this.shown) return;
      this.answers = answers;
      this.body.replaceChildren(...this.results(shown.lesson.steps[shown.step - 1]?.question, shown.step));
      this.tools.hidden = false;
    } catch (error) {
      this.refuse((error as Error).message);
    } finally {
      this.pending -= 1;
    }
  }

  /** Shows why there are no answers; they go on without names if only those are refused. */
  private refuse(reason: string): void {
    if (this.names.checked) {
      this.names.checked = false;
      return this.fault.replaceChildren(alertMessage(reason));
    }
    this.stop();
    this.tools.hidden = true;
    this.body.replaceChildren(alertMessage(reason));
  }

  private stop(): void {
    clearInterval(this.timer);
    this.timer = undefined;
  }

  private results(question: Question | undefined, step: number): HTMLElement[] {
    const parts = question === undefined ? [] : this.ofQuestion(question, step);
    const tests = compareTests(this.answers);
    const percent = (share: number) => `${Math.round(100 * share)} %`;
    if (tests !== undefined) {
      const gain = Math.round(100 * (tests.after - tests.before));
      const points = `${gain >= 0 ? "+" : "−"}${Math.abs(gain)}`;
      const words = t(
        "Tests of {0}: {1} right before the lesson, {2} after it ({3} points).",
        tests.respondents,
        percent(tests.before),
        percent(tests.after),
        points,
      );
      parts.push(make("p", { id: "class-tests" }, words));
    }
    return parts.length > 0 ? parts : [make("p", {}, t("This step has no question."))];
  }

  private ofQuestion(question: Question, step: number): HTMLElement[] {
    const { answered, right, firstRight, counts, numbers } = summaryOf(this.answers, step, question);
    if (answered === 0) return [make("p", {}, t("No answer yet."))];
    const words = make("p", {}, t("{0} answered, {1} right, {2} at the first attempt.", answered, right, firstRight));
    const bars = question.answers.map((each, i) => bar(each.words, counts[i], answered, each.right));
    const unit = question.number?.unit ?? "";
    const texts = numbers.map((each) => decimal(String(each))).join("; ");
    const predicted = question.prediction !== undefined;
    const given =
      numbers.length === 0
        ? []
        : [make("p", {}, predicted ? t("Distances: {0}", texts) : t("Numbers [{0}]: {1}", unit, texts))];
    return [words, ...bars, ...given, ...this.named(question, step)];
  }

  private named(question: Question, step: number): HTMLElement[] {
    if (!this.names.checked) return [];
    const rows = this.answers
      .filter((each) => each.step === step && each.phase === AnswerPhase.UNSPECIFIED)
      .map(({ name, respondent, choices, number, right }) => {
        const words =
          number !== undefined
            ? decimal(String(number))
            : choices.map((i) => question.answers[i]?.words ?? "").join("; ");
        return make("li", {}, `${name || t("Number {0}", respondent)}: ${words}${right ? " ✓" : ""}`);
      });
    return [make("ul", {}, ...rows)];
  }

  private save(): void {
    if (this.shown === undefined) return;
    const { name, lesson } = this.shown;
    download(
      `${name.replaceAll(/[^a-z0-9-]+/g, "-")}-answers.csv`,
      new Blob([answersCsv(this.answers, lesson)], { type: "text/csv" }),
    );
  }
}

function bar(words: string, count: number, of: number, right: boolean): HTMLElement {
  const meter = make("progress", { max: of, value: count, ariaLabel: t("{0} of {1}: {2}", count, of, words) });
  return make(
    "div",
    { className: "answer-bar" },
    make("span", {}, `${words}${right ? " ✓" : ""}`),
    make("b", {}, String(count)),
    meter,
  );
}
