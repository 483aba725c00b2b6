import { make } from "../../dom/elements";
import type { Question } from "../../gen/phrenic/v1/lesson_pb";
import type { GivenAnswer } from "../../session/class_answers";
import { rightAnswers, rightNumber } from "../../session/lessons";
import { t } from "../../language/translate";

/**
 * A question with its answers, a button that checks them, and the explanation; it can be tried again. Calls `answered`
 * with each answer.
 */
export function questionForm(question: Question, answered: (answer: GivenAnswer) => void): HTMLElement {
  const result = make("p", { className: "answer" });
  result.setAttribute("role", "status");
  const { legend, rows, given } = questionFields(question, "answer");
  const check = make("button", { type: "submit" }, t("Check"));
  const form = make("form", {}, make("fieldset", { className: "question" }, legend, ...rows, check, result));
  form.onsubmit = (event) => {
    event.preventDefault();
    const answer = given();
    result.textContent =
      answer === undefined
        ? t("Choose an answer first.")
        : answer.right
          ? `${t("Right.")} ${question.explanation}`
          : `${t("Not yet.")} ${t("Try again.")}`;
    result.dataset.right = String(answer?.right === true);
    if (answer !== undefined) answered(answer);
  };
  return form;
}

/** The inputs of a question. */
export interface QuestionFields {
  legend: HTMLElement;
  rows: HTMLElement[];
  /** Returns what is entered; undefined if nothing is. */
  given(): GivenAnswer | undefined;
}

/** Returns the inputs of a question; `name` groups the answers of which one can be chosen. */
export function questionFields(question: Question, name: string): QuestionFields {
  const legend = make("legend", {}, question.words);
  return { legend, ...(question.number === undefined ? choiceRows(question, name) : numberRow(question)) };
}

function choiceRows(question: Question, name: string): Omit<QuestionFields, "legend"> {
  const several = question.answers.filter(({ right }) => right).length > 1;
  const inputs = question.answers.map(() => make("input", { type: several ? "checkbox" : "radio", name }));
  const rows = question.answers.map(({ words }, i) => make("label", {}, inputs[i], words));
  const given = () => {
    const choices = inputs.flatMap(({ checked }, i) => (checked ? [i] : []));
    return choices.length === 0 ? undefined : { choices, number: undefined, right: rightAnswers(question, choices) };
  };
  return { rows, given };
}

function numberRow(question: Question): Omit<QuestionFields, "legend"> {
  const unit = question.number?.unit ?? "";
  const input = make("input", { type: "number", step: "any", ariaLabel: t("Your answer in {0}", unit) });
  const given = () => {
    const number = input.valueAsNumber;
    return Number.isNaN(number) ? undefined : { choices: [], number, right: rightNumber(question, number) };
  };
  return { rows: [make("label", {}, input, ` ${unit}`)], given };
}
