import { make } from "../../dom/elements";
import type { Lesson, LessonStep, Question } from "../../gen/phrenic/v1/lesson_pb";
import { t } from "../../language/translate";

/** What a worksheet shows beside the words of its lesson. */
export interface WorksheetParts {
  /** Addresses of pictures by the number of the step, from 1; steps without one have no picture. */
  pictures: ReadonlyMap<number, string>;
  /** True if the scene has lungs, so that a curve of the air in them can be predicted. */
  predicts: boolean;
}

/** Returns the sheet of a pupil: each step with its task and question, and room for answers, without answers. */
export function worksheet(lesson: Lesson, parts: WorksheetParts): HTMLElement {
  const lines = ["Name", "Class", "Date"].map((label) => make("p", {}, label, make("span", { className: "line" })));
  return make(
    "article",
    { className: "sheet" },
    make("h1", {}, lesson.title),
    make("p", { className: "summary" }, lesson.summary),
    make("div", { className: "who" }, ...lines),
    ...lesson.steps.map((step, i) => stepSection(step, i + 1, parts)),
    disclaimer(),
  );
}

/** Returns the sheet of a teacher: the right answers and why they are right. */
export function answerSheet(lesson: Lesson): HTMLElement {
  const answers = lesson.steps.flatMap(({ title, question }, i) =>
    question === undefined ? [] : [make("section", {}, make("h2", {}, `${i + 1}. ${title}`), ...answerOf(question))],
  );
  const none = make("p", {}, t("This lesson has no questions."));
  const head = [
    make("h1", {}, t("Answers: {0}", lesson.title)),
    make("p", { className: "summary" }, t("For the teacher.")),
  ];
  return make("article", { className: "sheet" }, ...head, ...(answers.length > 0 ? answers : [none]), disclaimer());
}

function stepSection(step: LessonStep, number: number, { pictures, predicts }: WorksheetParts): HTMLElement {
  const picture = pictures.get(number);
  const changes = step.preset !== "" || step.parameters !== undefined;
  const drawings = [
    ...(picture === undefined ? [] : [make("img", { src: picture, alt: t("The view of step {0}", number) })]),
    ...(predicts && changes ? [predictionAxes()] : []),
  ];
  return make(
    "section",
    {},
    make("h2", {}, `${number}. ${step.title}`),
    make("p", {}, step.caption),
    ...(drawings.length === 0 ? [] : [make("div", { className: "drawings" }, ...drawings)]),
    ...(step.task === "" ? [] : [make("p", {}, make("b", {}, t("Try: ")), step.task)]),
    ...(step.question === undefined ? ruled("What I saw:", 2) : questionRoom(step.question)),
  );
}

function questionRoom(question: Question): HTMLElement[] {
  const words = make("p", { className: "asked" }, question.words);
  if (question.number !== undefined) {
    const blank = make("span", { className: "blank" });
    return [words, make("p", {}, t("Answer: "), blank, ` ${question.number.unit}`), ...ruled("Because:", 1)];
  }
  if (question.prediction !== undefined) return [words, predictionAxes(), ...ruled("Because:", 1)];
  const boxes = question.answers.map((answer) => make("li", {}, make("span", { className: "box" }), answer.words));
  return [words, make("ul", {}, ...boxes), ...ruled("Because:", 1)];
}

function answerOf({ words, answers, number, explanation, prediction }: Question): HTMLElement[] {
  const right =
    prediction !== undefined
      ? [t("a curve within {0} of the breath on average", prediction.tolerance)]
      : number === undefined
        ? answers.filter((answer) => answer.right).map((answer) => answer.words)
        : [`${number.value} ${number.unit}, ${number.tolerance} more or less`];
  const list = make("ul", {}, ...right.map((each) => make("li", {}, make("b", {}, each))));
  return [make("p", { className: "asked" }, words), list, make("p", {}, explanation)];
}

/** Returns words and lines to write on. */
function ruled(words: string, count: number): HTMLElement[] {
  const lines = Array.from({ length: count }, () => make("div", { className: "line" }));
  return [make("p", { className: "ruled" }, words), ...lines];
}

/** Returns empty axes of the air in the lungs over one breath. */
function predictionAxes(): HTMLElement {
  const space = "http://www.w3.org/2000/svg";
  const svg = document.createElementNS(space, "svg");
  svg.setAttribute("viewBox", "22 0 260 156");
  svg.setAttribute("role", "img");
  svg.setAttribute("aria-label", t("Empty axes: air in the lungs over the time of one breath"));
  const path = (d: string, name: string) => {
    const element = document.createElementNS(space, "path");
    element.setAttribute("d", d);
    element.setAttribute("class", name);
    svg.append(element);
  };
  const columns = Array.from({ length: 8 }, (_, i) => `M${60 + 30 * i} 10V150`);
  const rows = Array.from({ length: 5 }, (_, i) => `M30 ${10 + 28 * i}H270`);
  path([...columns, ...rows].join(""), "grid");
  path("M30 4V150H278M26 10L30 3L34 10M271 146L278 150L271 154", "axes");
  const words = make(
    "figcaption",
    {},
    t("Draw what you expect: air in the lungs (up) over one breath (to the right)."),
  );
  return make("figure", {}, svg, words);
}

function disclaimer(): HTMLElement {
  return make("p", { className: "small" }, t("Phrenic. Research and teaching; not for clinical use."));
}
